// SPDX-License-Identifier: Apache-2.0
#include "app/result_directory.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "io/atomic_file.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_result(const fs::path& out, const std::string& file, const std::string& text) {
  ResultDirectory result(out, "track camera");
  result.write_text(file, text);
  result.commit({{"frames", 7}});
}

TEST(ResultDirectory, IsCompleteAfterCommit) {
  const test::TemporaryDirectory directory;
  write_result(directory / "a/b", "plots/ape.txt", "hello");
  EXPECT_EQ(content(directory / "a/b/plots/ape.txt"), "hello");
  const auto summary = nlohmann::json::parse(content(directory / "a/b/summary.json"));
  EXPECT_EQ(summary["frames"], 7);
  EXPECT_EQ(summary["verb"], "track camera");
  EXPECT_EQ(summary["files"], (std::vector<std::string>{"plots", "summary.json"}));
  EXPECT_FALSE(fs::exists(directory / "a/b/.part"));
}

TEST(ResultDirectory, LeavesNothingBehindWithoutCommit) {
  const test::TemporaryDirectory directory;
  { ResultDirectory(directory / "out", "track camera").write_text("trajectory.tum", "1 2 3"); }
  EXPECT_FALSE(fs::exists(directory / "out"));
}

TEST(ResultDirectory, KeepsTheEarlierResultUntilCommit) {
  const test::TemporaryDirectory directory;
  write_result(directory / "out", "trajectory.tum", "old");
  { ResultDirectory(directory / "out", "track camera").write_text("trajectory.tum", "new"); }
  EXPECT_EQ(content(directory / "out/trajectory.tum"), "old");
  EXPECT_TRUE(fs::exists(directory / "out/summary.json"));
}

TEST(ResultDirectory, CommitReplacesOurEarlierFilesAndNoOthers) {
  const test::TemporaryDirectory directory;
  write_result(directory / "out", "old.txt", "old");
  directory.write("out/notes.txt", "the user's");
  write_result(directory / "out", "new.txt", "new");
  EXPECT_FALSE(fs::exists(directory / "out/old.txt"));
  EXPECT_EQ(content(directory / "out/new.txt"), "new");
  EXPECT_EQ(content(directory / "out/notes.txt"), "the user's");
}

TEST(ResultDirectory, RefusesADirectoryThatIsNotOurs) {
  const test::TemporaryDirectory directory;
  directory.write("thesis.tex", "precious");
  EXPECT_THROW(ResultDirectory(directory.path(), "track camera"), InputError);
  directory.write("summary.json", R"({"program": "another"})");
  EXPECT_THROW(ResultDirectory(directory.path(), "track camera"), InputError);
  EXPECT_THROW(ResultDirectory(directory / "thesis.tex", "track camera"), InputError);
  EXPECT_EQ(content(directory / "thesis.tex"), "precious");
}

TEST(ResultDirectory, TakesWhatAKilledRunLeft) {
  const test::TemporaryDirectory directory;
  fs::create_directories(directory / "out/.part");
  directory.write("out/.part/trajectory.tum", "half");
  write_result(directory / "out", "map.ply", "whole");
  EXPECT_FALSE(fs::exists(directory / "out/trajectory.tum"));
  EXPECT_FALSE(fs::exists(directory / "out/.part"));
}

TEST(ResultDirectory, NeverFollowsNamesOutOfTheDirectory) {
  const test::TemporaryDirectory directory;
  directory.write("precious.txt", "precious");
  fs::create_directory(directory / "out");
  directory.write("out/summary.json", R"({"program": "alidade", "files": ["../precious.txt", "..", ".", "a", 3]})");
  write_result(directory / "out", "map.ply", "whole");
  EXPECT_EQ(content(directory / "precious.txt"), "precious");
  EXPECT_EQ(content(directory / "out/map.ply"), "whole");
}

TEST(ResultDirectory, NamesTheFileThatTheSystemRefused) {
  const test::TemporaryDirectory directory;
  ResultDirectory result(directory / "out", "track camera");
  fs::create_directory(part_name(result.path("map.ply")));  // where the file would be written
  try {
    result.write_text("map.ply", "whole");
    FAIL() << "the refusal went unnoticed";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("map.ply: cannot be created: Is a directory"));
  }
}

}  // namespace
}  // namespace alidade
