// SPDX-License-Identifier: Apache-2.0
#include "app/simulation_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

SimulationRecord record_of_two_frames() {
  SimulationRecord record;
  record.options.frames = 9;
  record.options.marker_m = 0.2;
  record.truth.resize(2);
  record.truth[1].time = Timestamp(std::chrono::seconds(1));
  record.truth[1].T_world_camera.translation().x() = 0.75;
  record.T_world_marker = Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3));
  record.interrupted = true;
  return record;
}

TEST(SimulationSummary, TellsWhatWasWrittenAndWhereTheMarkerIs) {
  const nlohmann::json summary = summary_of(record_of_two_frames());
  EXPECT_EQ(summary["frames"], 2);
  EXPECT_EQ(summary["frames_wanted"], 9);
  EXPECT_DOUBLE_EQ(summary["path_length_m"], 0.75);
  EXPECT_EQ(summary["interrupted"], true);
  EXPECT_EQ(summary["marker"]["T_world_marker"][1][3], 2.0);
  EXPECT_EQ(summary["marker"]["side_m"], 0.2);
  SimulationRecord plain = record_of_two_frames();
  plain.T_world_marker.reset();
  EXPECT_FALSE(summary_of(plain).contains("marker"));
}

TEST(SimulationReport, ShowsFramesAndTruthAndWarnsOfAnInterruption) {
  SimulationRecord record = record_of_two_frames();
  record.frames = {cv::Mat::zeros(4, 4, CV_8UC3), cv::Mat::zeros(4, 4, CV_8UC3)};
  const Report report = report_of(record, {"alidade", "simulate"}, "frames: 9\n");
  ASSERT_EQ(report.sections.size(), 2u);
  EXPECT_EQ(report.sections[0].figures.size(), 2u);
  EXPECT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.options, "frames: 9\n");
  record.interrupted = false;
  EXPECT_TRUE(report_of(record, {}, "").warnings.empty());
}

}  // namespace
}  // namespace alidade
