// SPDX-License-Identifier: Apache-2.0
#include "io/text_lines.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

TEST(SignificantLines, KeepTheirNumbersPastCommentsBlanksAndMarks) {
  const auto lines = significant_lines("\xEF\xBB\xBF# head\r\n\r\n one two \r\n#x\nthree");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].number, 3);
  EXPECT_EQ(lines[0].text, "one two");
  EXPECT_EQ(lines[1].number, 5);
  EXPECT_EQ(lines[1].text, "three");
}

TEST(SplitWords, PartsAtBlanksAndTabs) {
  EXPECT_EQ(split_words("  a\tb   c "), (std::vector<std::string_view>{"a", "b", "c"}));
  EXPECT_TRUE(split_words(" \t ").empty());
}

TEST(ParseNumber, TakesWhatIsANumberAndNothingElse) {
  EXPECT_EQ(parse_number("f", 1, "-1.5e-3"), -1.5e-3);
  EXPECT_EQ(parse_number("f", 1, "+2"), 2.0);
  const auto message = [](std::string_view word) {
    return test::message_of("/", [&] { parse_number("f.txt", 7, word); });
  };
  EXPECT_EQ(message("1.5x"), "f.txt:7: '1.5x' is not a number");
  EXPECT_EQ(message(""), "f.txt:7: '' is not a number");
  EXPECT_EQ(message("nan"), "f.txt:7: 'nan' is not a finite number");
  EXPECT_EQ(message("-inf"), "f.txt:7: '-inf' is not a finite number");
  EXPECT_EQ(message("1e999"), "f.txt:7: '1e999' is out of the range of numbers");
}

TEST(ParseInteger, RefusesFractions) {
  EXPECT_EQ(parse_integer("f", 1, "-1305031229528748000"), -1305031229528748000LL);
  EXPECT_EQ(test::message_of("/", [] { parse_integer("f.txt", 2, "1.0"); }), "f.txt:2: '1.0' is not a whole number");
}

TEST(ReadBytes, SaysWhyAFileCannotBeRead) {
  const test::TemporaryDirectory folder;
  EXPECT_EQ(test::message_of(folder.path(), [&] { read_bytes(folder / "none"); }),
            "none: cannot be opened: No such file or directory; check the name");
  EXPECT_EQ(test::message_of(folder.path().parent_path(), [&] { read_bytes(folder.path()); }),
            folder.path().filename().string() + ": is a folder, a file is wanted");
}

}  // namespace
}  // namespace alidade
