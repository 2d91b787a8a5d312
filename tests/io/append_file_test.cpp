// SPDX-License-Identifier: Apache-2.0
#include "io/append_file.h"

#include <gtest/gtest.h>

#include "io/checksum.h"
#include "io/text_lines.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

class AppendedFile : public testing::Test {
 protected:
  std::string part() const { return read_bytes(folder_ / "a.part"); }
  test::TemporaryDirectory folder_;
};

TEST_F(AppendedFile, HoldsEveryPieceAtOnceAndItsNameAtTheEnd) {
  AppendFile file(folder_ / "a");
  file.append({"one,", "", "two"});
  EXPECT_EQ(part(), "one,two");
  file.append({"!"});
  EXPECT_EQ(file.size(), 8);
  file.commit();
  EXPECT_EQ(read_bytes(folder_ / "a"), "one,two!");
  EXPECT_THROW(file.commit(), std::invalid_argument);
}

TEST_F(AppendedFile, StaysWhenItsWriterGoesAndIsGoneOnWith) {
  { AppendFile(folder_ / "a").append({"12345"}); }
  EXPECT_EQ(part(), "12345");
  AppendFile file(folder_ / "a", AppendFile::Start::AtEnd);
  file.overwrite(1, "xx");
  file.append({"6"});
  EXPECT_EQ(part(), "1xx456");
  file.cut(2);
  file.append({"7"});
  EXPECT_EQ(part(), "1x7");
  EXPECT_THROW(file.overwrite(2, "ab"), std::invalid_argument);
  file.start_writeback();
}

TEST_F(AppendedFile, IsAsBeforeWhereAPieceDoesNotFit) {
  AppendFile file(folder_ / "a");
  file.append({std::string(90, 'x')});
  {
    const test::FileSizeLimit limit(100);
    try {
      file.append({"1234567", std::string(50, 'y')});
      FAIL() << "a piece of 57 bytes found room in 10";
    } catch (const DiskFull& full) {
      EXPECT_EQ(full.limit(), "largest size of a file reached");
    }
    EXPECT_EQ(part(), std::string(90, 'x'));
    file.append({"0123456789"});
  }
  EXPECT_EQ(part(), std::string(90, 'x') + "0123456789");
}

TEST_F(AppendedFile, IsRefusedInOneLine) {
  EXPECT_EQ(test::message_of(folder_.path(), [&] { AppendFile(folder_ / "none/a"); }),
            "none/a: cannot be created: No such file or directory; create the folder first");
  std::filesystem::create_symlink("/dev/full", folder_ / "b.part");
  EXPECT_EQ(test::message_of(folder_.path(), [&] { AppendFile(folder_ / "b").append({"x"}); }),
            "b: cannot be written: No space left on device; free some space and run it again");
}

TEST(Crc32, IsThatOfZip) {
  EXPECT_EQ(Crc32("123456789").value(), 0xCBF43926u);  // the check value of every list of CRCs
  EXPECT_EQ(Crc32().value(), 0u);
}

TEST(Crc32, OfPartsIsThatOfTheWhole) {
  Crc32 whole("lossless"), parts("loss");
  parts.add(std::string_view("le"));
  parts.add(Crc32("ss"));
  EXPECT_EQ(parts.value(), whole.value());
  EXPECT_EQ(parts.length(), whole.length());
}

TEST(Crc32, OfAFileIsThatOfItsBytes) {
  const test::TemporaryDirectory folder;
  const std::string text(200'000, 'z');
  EXPECT_EQ(crc32_of_file(folder.write("a", text)).value(), Crc32(text).value());
  EXPECT_THROW(crc32_of_file(folder / "none"), InputError);
}

}  // namespace
}  // namespace alidade
