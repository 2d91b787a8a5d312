// SPDX-License-Identifier: Apache-2.0
#include "io/text_rows.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using Fields = std::vector<std::string>;

TEST(ReadRows, SplitsEachLineAtItsOwnSeparator) {
  const test::TemporaryDirectory folder;
  const auto rows = read_rows(folder.write("a.txt", "# comment\n1  2\t3\n\n4, 5,,6\r\n"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].fields, (Fields{"1", "2", "3"}));
  EXPECT_EQ(rows[0].line, 2);
  EXPECT_FALSE(rows[0].commas);
  EXPECT_EQ(rows[1].fields, (Fields{"4", "5", "", "6"}));
  EXPECT_EQ(rows[1].line, 4);
  EXPECT_TRUE(rows[1].commas);
}

TEST(FiniteNumber, RefusesWhatIsNone) {
  EXPECT_EQ(finite_number("a.txt", {7, false, {"1", "-2.5e1"}}, 1), -25.0);
  for (const char* text : {"", "nan", "inf", "1.0x", "1e999"}) {
    EXPECT_THROW(finite_number("a.txt", {7, false, {text}}, 0), InputError) << text;
  }
}

}  // namespace
}  // namespace alidade
