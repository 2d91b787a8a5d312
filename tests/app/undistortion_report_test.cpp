// SPDX-License-Identifier: Apache-2.0
#include "app/undistortion_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

UndistortionRecord record_of_one_frame() {
  UndistortionRecord record;
  record.source = "1 image a.png";
  record.pinhole = {64, 48, 50, 51, 31.5, 23.5, {}};
  record.frames = 1;
  record.before = record.after = cv::Mat::zeros(48, 64, CV_8U);
  record.warnings = {"a.png: is dark"};
  return record;
}

TEST(UndistortionSummary, TellsTheNewCamera) {
  const nlohmann::json summary = summary_of(record_of_one_frame());
  EXPECT_EQ(summary["frames"], 1);
  EXPECT_EQ(summary["intrinsics_px"]["fy"], 51);
  EXPECT_EQ(summary["interrupted"], false);
  EXPECT_EQ(summary["warnings"].size(), 1u);
}

TEST(UndistortionReport, ShowsTheFrameBeforeAndAfterAndWarnsOfAnInterruption) {
  UndistortionRecord record = record_of_one_frame();
  record.interrupted = true;
  const Report report = report_of(record, {"alidade", "undistort"}, "alpha: 0\n");
  EXPECT_EQ(report.sections.at(0).figures.size(), 2u);
  EXPECT_EQ(report.warnings.size(), 2u);
  EXPECT_EQ(report.options, "alpha: 0\n");
  EXPECT_TRUE(report_of(UndistortionRecord{}, {}, "").sections.at(0).figures.empty());
}

}  // namespace
}  // namespace alidade
