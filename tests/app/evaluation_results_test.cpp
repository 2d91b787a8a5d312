// SPDX-License-Identifier: Apache-2.0
#include "app/evaluation_results.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/evaluation_report.h"

namespace alidade {
namespace {

// A unit square walked in 3 s (path 3 m), the estimate 0.1 m above it, with a covariance for the last pose only.
EvaluationRecord square() {
  EvaluationRecord record;
  record.estimate.path = "out/trajectory.tum";
  record.truth.path = "truth.txt";
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}) {
    StampedPose pose;
    pose.time = Timestamp(std::chrono::seconds(record.truth.poses.size()));
    pose.T_world_camera.translation() = p;
    record.truth.poses.push_back(pose);
    pose.T_world_camera.translation().y() += 0.1;
    record.estimate.poses.push_back(pose);
  }
  record.estimate.poses.back().covariance = 0.01 * Matrix6d::Identity();
  record.options.alignment = AlignmentKind::None;
  record.evaluation = evaluate({record.estimate.poses, record.truth.poses}, record.options).value();
  return record;
}

bool has_line(const std::vector<std::string>& lines, const std::string& expected) {
  return std::find(lines.begin(), lines.end(), expected) != lines.end();
}

TEST(EvaluationTable, NamesSourcesAlignmentAndPath) {
  const auto lines = table_lines(square());
  EXPECT_TRUE(has_line(lines, "estimate    out/trajectory.tum (4 poses)"));
  EXPECT_TRUE(has_line(lines, "truth       truth.txt (4 poses)"));
  EXPECT_TRUE(has_line(lines, "associated  4 poses by time, at most 0.01 s apart"));
  EXPECT_TRUE(has_line(lines, "alignment   none, scale 1.000000"));
  EXPECT_TRUE(has_line(lines, "path        3.000000 m"));
}

TEST(EvaluationTable, HasColumnsUnderTheirNames) {
  const auto lines = table_lines(square());
  const auto header = std::find_if(lines.begin(), lines.end(), [](const auto& l) { return l.ends_with("max"); });
  const auto row = std::find_if(lines.begin(), lines.end(), [](const auto& l) { return l.starts_with("APE trans"); });
  ASSERT_NE(row, lines.end());
  EXPECT_EQ(header->size(), row->size());
  EXPECT_EQ(row->substr(header->find("rmse") + 4 - 8, 8), "0.100000");
  EXPECT_EQ(row->substr(header->find("std") + 3 - 8, 8), "0.000000");
}

TEST(EvaluationTable, SaysNoneWhereNoSpanIsLongEnough) {
  EvaluationRecord record = square();
  record.options.step = PathStep{10};
  record.evaluation = evaluate({record.estimate.poses, record.truth.poses}, record.options).value();
  const auto lines = table_lines(record);
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
    return line.starts_with("RPE translation [m] over 10 m") && line.ends_with("none");
  }));
  EXPECT_TRUE(summary_of(record).at("rpe_translation_m").is_null());
}

// The last pose is one sigma (0.1 m) off in one of its six degrees of freedom.
TEST(EvaluationSummary, HoldsStatisticsWithUnits) {
  const nlohmann::json summary = summary_of(square());
  EXPECT_NEAR(summary.at("ape_translation_m").at("rmse").get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(summary.at("translation_percent_of_path").at("mean").get<double>(), 100 * 0.1 / 3, 1e-9);
  EXPECT_EQ(summary.at("associated_poses"), 4);
  EXPECT_EQ(summary.at("alignment"), "none");
  EXPECT_EQ(summary.at("nees").at("count"), 1);
  EXPECT_NEAR(summary.at("nees").at("mean_per_degree_of_freedom").get<double>(), 1.0 / 6.0, 1e-12);
}

TEST(EvaluationCsv, HasALinePerPoseAndAnEmptyCellWithoutCovariance) {
  const std::string csv = errors_csv(square());
  EXPECT_TRUE(csv.starts_with("t_ns,translation_m,rotation_deg,of_path_percent,nees\n0,0.1,0,")) << csv;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_NE(csv.find("\n1000000000,"), std::string::npos);
  EXPECT_NE(csv.find(",\n"), std::string::npos);
}

TEST(NameOf, ReadsAsOnTheCommandLine) {
  EXPECT_EQ(name_of(AlignmentKind::Rigid), "se3");
  EXPECT_EQ(name_of(AlignmentKind::Similarity), "sim3");
  EXPECT_EQ(name_of(Step{FrameStep{1}}), "1 frame");
  EXPECT_EQ(name_of(Step{FrameStep{5}}), "5 frames");
  EXPECT_EQ(name_of(Step{PathStep{0.5}}), "0.5 m");
  EXPECT_EQ(name_of(Step{TimeStep{2}}), "2 s");
}

TEST(EvaluationReport, HoldsThePicturesAndTheFigures) {
  const EvaluationRecord record = square();
  const Report report = report_of(record, {"alidade", "evaluate"}, "align: none\n");
  ASSERT_EQ(report.sections.size(), 2u);
  EXPECT_FALSE(report.sections[0].figures.at(0).image.empty());
  EXPECT_FALSE(report.sections[1].figures.at(0).image.empty());
  EXPECT_EQ(report.options, "align: none\n");
  const auto row = std::find_if(report.summary.begin(), report.summary.end(),
                                [](const ReportRow& r) { return r.name == "absolute position error, RMSE"; });
  ASSERT_NE(row, report.summary.end());
  EXPECT_EQ(row->value, "0.1");
  EXPECT_EQ(row->unit, "m");
}

// The error plot grows by a third plot where there are covariances.
TEST(EvaluationReport, DrawsNeesWhereThereAreCovariances) {
  EvaluationRecord record = square();
  const int with_nees = draw_errors(record).rows;
  record.evaluation.consistency.reset();
  EXPECT_EQ(3 * draw_errors(record).rows, 2 * with_nees);
}

}  // namespace
}  // namespace alidade
