// SPDX-License-Identifier: Apache-2.0
#include "app/recording_checks.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

VerifiedRecording with_faults(int count) {
  VerifiedRecording verified{"rec", {}};
  verified.result.is_closed = true;
  verified.result.totals = {1, 0, 0, 0, 0, 0};
  verified.result.bytes = 1'500'000;
  for (int i = 0; i < count; ++i) verified.result.faults.push_back({"rec/frames.csv", i + 2, "is odd"});
  return verified;
}

TEST(RecordingReport, OfARepairSaysWhatWasDone) {
  RecordingRepair repair;
  repair.totals = {300, 1, 2, 4, 5, 6};
  repair.lost = 1;
  repair.cut_bytes = 77;
  EXPECT_EQ(line_of("rec", repair),
            "rec: closed with 300 frames (1 without an image, 2 damaged by the camera, 4 recovered), 5 dropped by the "
            "camera, 6 discarded since recording was too slow; 1 row that the disk never got given up; 77 bytes of "
            "unfinished writing cut off");
  repair = {};
  repair.was_closed = true;
  EXPECT_EQ(line_of("rec", repair), "rec: needs no repair, 0 frames");
  EXPECT_EQ(summary_of("rec", repair)["was_closed"], true);
}

TEST(RecordingReport, OfFaultsListsTheFirstOnes) {
  EXPECT_EQ(lines_of(with_faults(0)), std::vector<std::string>{"rec: 1 frame, 1.5 MB: no fault"});
  EXPECT_EQ(lines_of(with_faults(1)),
            (std::vector<std::string>{"rec: 1 frame, 1.5 MB: 1 fault", "rec/frames.csv:2: is odd"}));
  const auto many = lines_of(with_faults(25));
  EXPECT_EQ(many.size(), 22u);
  EXPECT_EQ(many.back(), "and 5 more");
  EXPECT_EQ(summary_of(with_faults(25))["faults"].size(), 25u);
}

TEST(RecordingReport, InOneLineNamesTheFirstFault) {
  const auto error = [](const VerifiedRecording& verified) {
    return std::string(error_of(std::vector{verified}).what());
  };
  EXPECT_EQ(error(with_faults(1)), "rec/frames.csv:2: is odd; take it from a copy of the recording");
  EXPECT_EQ(error(with_faults(2)), "rec/frames.csv:2: is odd (and 1 fault more); take it from a copy of the recording");
  VerifiedRecording open = with_faults(1);
  open.result.is_closed = false;
  EXPECT_EQ(error(open), "rec/frames.csv:2: is odd; run 'alidade repair rec'");
}

TEST(RecordingReport, IsOfRecordingsOnly) {
  const test::TemporaryDirectory folder;
  EXPECT_NE(test::message_of(folder.path(), [&] { find_recordings(folder.path()); }).find("is no recording"),
            std::string::npos);
}

}  // namespace
}  // namespace alidade
