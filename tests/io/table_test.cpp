// SPDX-License-Identifier: Apache-2.0
#include "io/table.h"

#include <gtest/gtest.h>

#include "io/text_lines.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

class TableFile : public testing::Test {
 protected:
  std::string message_reading(std::string_view text) {
    return test::message_of(folder_.path(), [&] { read_table(folder_.write("t.csv", text)); });
  }
  test::TemporaryDirectory folder_;
};

TEST_F(TableFile, IsReadWithCommentsBlankLinesAndCarriageReturns) {
  const Table table =
      read_table(folder_.write("t.csv", "# made by hand\r\nt_ns, x_m ,name\r\n\r\n5,1.5,\"a, \"\"b\"\"\"\r\n"));
  ASSERT_EQ(table.row_count(), 1u);
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"t_ns", "x_m", "name"}));
  EXPECT_EQ(table.integer(0, table.column("t_ns")), 5);
  EXPECT_EQ(table.number(0, table.column("x_m")), 1.5);
  EXPECT_EQ(table.text(0, 2), "a, \"b\"");
  EXPECT_FALSE(table.has_column("y_m"));
}

TEST_F(TableFile, IsRefusedDownToTheLine) {
  EXPECT_EQ(message_reading("# nothing\n\n"), "t.csv: is empty; its first line must name the columns");
  EXPECT_EQ(message_reading("a,b\n1,2\n\n1,2,3\n"),
            "t.csv:4: has 3 cells, the header names 2; correct the row or leave it out");
  EXPECT_EQ(message_reading("a,b\n1\n"), "t.csv:2: has 1 cells, the header names 2; correct the row or leave it out");
  EXPECT_EQ(message_reading("a,,c\n"), "t.csv:1: column 2 has no name");
  EXPECT_EQ(message_reading("a,b,a\n"), "t.csv:1: two columns are named 'a'");
  EXPECT_EQ(message_reading("a\n\"x\n"), "t.csv:2: a quoted cell does not end at its quote; double quotes in cells");
}

TEST_F(TableFile, NamesTheCellThatIsNoNumber) {
  const Table table = read_table(folder_.write("t.csv", "x_m,t_ns\nabc,1.5\nnan,7\n"));
  const auto message = [&](auto work) { return test::message_of(folder_.path(), work); };
  EXPECT_EQ(message([&] { table.number(0, 0); }),
            "t.csv:2: column 'x_m': 'abc' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(message([&] { table.integer(0, 1); }),
            "t.csv:2: column 't_ns': '1.5' is not a whole number; correct it or leave the row out");
  EXPECT_EQ(message([&] { table.number(1, 0); }),
            "t.csv:3: column 'x_m': 'nan' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(message([&] { table.column("t_us"); }), "t.csv: has no column 't_us'; did you mean 't_ns'?");
  EXPECT_EQ(message([&] { table.column("colour"); }), "t.csv: has no column 'colour'; known are: x_m, t_ns");
}

TEST_F(TableFile, GivesBackWhatTheWriterWrote) {
  constexpr std::string_view kColumns[] = {"t_ns", "x_m", "name"};
  TableWriter writer(folder_ / "t.csv", kColumns);
  writer.write_row({std::int64_t{1305031229528748123}, 0.1 + 0.2, "#plain, \"quoted\""});
  writer.write_row({std::int64_t{-1}, -1e-300, ""});
  EXPECT_THROW(writer.write_row({1.0}), std::invalid_argument);
  writer.commit();
  const Table table = read_table(folder_ / "t.csv");
  ASSERT_EQ(table.row_count(), 2u);
  EXPECT_EQ(table.integer(0, 0), 1305031229528748123);
  EXPECT_EQ(table.number(0, 1), 0.1 + 0.2);
  EXPECT_EQ(table.text(0, 2), "#plain, \"quoted\"");
  EXPECT_EQ(table.number(1, 1), -1e-300);
  EXPECT_EQ(table.text(1, 2), "");
}

}  // namespace
}  // namespace alidade
