// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.h"

#include <gtest/gtest.h>

#include "io/text_lines.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using std::filesystem::exists;

TEST(AtomicFile, AppearsAtCommitAndNotBefore) {
  const test::TemporaryDirectory folder;
  AtomicFile file(folder / "a.txt");
  file.write("some ");
  file.write("bytes");
  EXPECT_FALSE(exists(folder / "a.txt"));
  EXPECT_TRUE(exists(folder / "a.txt.part"));
  file.commit();
  EXPECT_EQ(read_bytes(folder / "a.txt"), "some bytes");
  EXPECT_FALSE(exists(folder / "a.txt.part"));
}

TEST(AtomicFile, LeavesTheOldFileWhereItIsNotCommitted) {
  const test::TemporaryDirectory folder;
  folder.write("a.txt", "old");
  { AtomicFile(folder / "a.txt").write("new"); }
  EXPECT_EQ(read_bytes(folder / "a.txt"), "old");
  EXPECT_FALSE(exists(folder / "a.txt.part"));
}

TEST(AtomicFile, TellsOfAFullDiskAndLeavesNothing) {
  const test::TemporaryDirectory folder;
  std::filesystem::create_symlink("/dev/full", folder / "a.txt.part");  // every write there meets ENOSPC
  EXPECT_EQ(test::message_of(folder.path(), [&] { write_file(folder / "a.txt", "bytes"); }),
            "a.txt: cannot be written: No space left on device; free some space and run it again");
  EXPECT_FALSE(exists(folder / "a.txt"));
  EXPECT_FALSE(std::filesystem::is_symlink(folder / "a.txt.part"));
}

TEST(AtomicFile, TellsOfAMissingFolder) {
  const test::TemporaryDirectory folder;
  EXPECT_EQ(test::message_of(folder.path(), [&] { write_file(folder / "none/a.txt", "bytes"); }),
            "none/a.txt: cannot be created: No such file or directory; create the folder first");
}

TEST(AtomicFile, IsNotWrittenAfterCommit) {
  const test::TemporaryDirectory folder;
  AtomicFile file(folder / "a");
  file.commit();
  EXPECT_THROW(file.write("x"), std::invalid_argument);
  EXPECT_THROW(file.commit(), std::invalid_argument);
}

TEST(AtomicFile, KeepsALotOfBytesInOrder) {
  const test::TemporaryDirectory folder;
  std::string all;
  AtomicFile file(folder / "a");
  for (int i = 0; i < 40'000; ++i) {
    const std::string piece = std::to_string(i) + "\n";
    file.write(piece);
    all += piece;
  }
  file.commit();
  EXPECT_EQ(read_bytes(folder / "a"), all);
}

}  // namespace
}  // namespace alidade
