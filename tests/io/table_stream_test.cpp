// SPDX-License-Identifier: Apache-2.0
#include "io/table_stream.h"

#include <array>
#include <chrono>

#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;
using test::message_of;

class TableStreamTest : public ::testing::Test {
 protected:
  test::TemporaryDirectory folder_;
};

TEST_F(TableStreamTest, GivesCellsByColumnRowByRow) {
  TableStream table(folder_.write("t.csv",
                                  "\xEF\xBB\xBF"
                                  "a, b ,t_s\n# a remark\n 1 ,-2.5,3.000000001\n\n4,,5\n"));
  const int a = table.require("a"), b = table.find("b"), t = table.find("t_s");
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.integer(a), 1);
  EXPECT_EQ(table.number(b), -2.5);
  EXPECT_EQ(table.time(-1, t), Timestamp(3s + 1ns));
  ASSERT_TRUE(table.next());
  EXPECT_TRUE(table.has(a));
  EXPECT_FALSE(table.has(b));
  EXPECT_FALSE(table.has(table.find("c")));
  EXPECT_FALSE(table.next());
}

TEST_F(TableStreamTest, NamesFileLineAndColumn) {
  TableStream table(folder_.write("t.csv", "# head\ntime,value\n1,2\nx,3\n1\n"));
  ASSERT_TRUE(table.next());
  EXPECT_EQ(message_of(folder_.path(), [&] { table.require("valu"); }),
            "t.csv:2: has no column 'valu'; did you mean 'value'?");
  ASSERT_TRUE(table.next());
  EXPECT_EQ(message_of(folder_.path(), [&] { table.integer(0); }),
            "t.csv:4: column 'time': 'x' is not a whole number; correct it or leave the row out");
  EXPECT_EQ(message_of(folder_.path(), [&] { table.next(); }),
            "t.csv:5: has 1 cells, the header names 2; correct the row or leave it out");
}

TEST_F(TableStreamTest, RefusesTwoColumnsOfOneName) {
  const auto path = folder_.write("t.csv", "a,b,a\n");
  EXPECT_EQ(message_of(folder_.path(), [&] { TableStream table(path); }), "t.csv:1: two columns are named 'a'");
}

TEST(ListIds, NamesADozenAtMost) {
  EXPECT_EQ(list_ids(std::array{3, 1}), "known are: 3, 1");
  EXPECT_EQ(list_ids(std::array{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}),
            "known are: 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, ...");
}

}  // namespace
}  // namespace alidade
