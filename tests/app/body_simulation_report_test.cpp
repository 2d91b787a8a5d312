// SPDX-License-Identifier: Apache-2.0
#include "app/body_simulation_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

BodySimulationRecord record_of(int frames, int written) {
  BodySimulationRecord record;
  record.options.frames = frames;
  record.truth_files = {"truth.tum"};
  record.body_names = {"body1"};
  for (int i = 0; i < written; ++i) {
    BodySceneFrame frame{Timestamp(std::chrono::milliseconds(4 * i)), std::vector<LineReading>(3), {true, false, true}};
    record.add(frame, {Eigen::Isometry3d(Eigen::Translation3d(0.1 * i, 0, 1))});
  }
  return record;
}

TEST(BodySimulationSummary, CountsWhatWasWritten) {
  BodySimulationRecord record = record_of(10, 4);
  record.interrupted = true;
  const nlohmann::json summary = summary_of(record);
  EXPECT_EQ(summary["frames"], 4);
  EXPECT_EQ(summary["frames_wanted"], 10);
  EXPECT_EQ(summary["readings"], 12);
  EXPECT_EQ(summary["readings_with_wrong_id"], 4);
  EXPECT_EQ(summary["detectors"], 12);
  EXPECT_EQ(summary["truth"][0], "truth.tum");
  EXPECT_EQ(summary["interrupted"], true);
}

TEST(BodySimulationRecord, KeepsNoMoreOfALongSequenceThanIsDrawn) {
  const BodySimulationRecord record = record_of(50000, 50000);
  EXPECT_EQ(record.frames, 50000);
  EXPECT_EQ(record.readings, 150000);
  EXPECT_EQ(record.truth[0].size(), 2000u);
  EXPECT_EQ(record.readings_per_frame.size(), 2000u);
}

TEST(BodySimulationReport, ShowsThePathsAndWarnsOfAnInterruption) {
  BodySimulationRecord record = record_of(10, 10);
  Report report = report_of(record, {"alidade", "simulate"}, "frames: 10\n");
  ASSERT_EQ(report.sections.size(), 1u);
  EXPECT_FALSE(report.sections[0].figures.at(0).image.empty());
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_EQ(report.options, "frames: 10\n");
  record.interrupted = true;
  EXPECT_EQ(report_of(record, {}, "").warnings.size(), 1u);
}

TEST(BodySimulationReport, StandsWithoutAnyFrame) {
  EXPECT_EQ(report_of(record_of(10, 0), {}, "").sections.size(), 1u);
}

}  // namespace
}  // namespace alidade
