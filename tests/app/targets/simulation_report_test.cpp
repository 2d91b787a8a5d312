// SPDX-License-Identifier: Apache-2.0
#include "app/targets/simulation_report.h"

#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

TargetSceneOptions scene_options() {
  TargetSceneOptions options;
  options.targets = 3;
  options.false_bearings = 2.0;
  options.comes_and_goes = true;
  options.periods = 10;
  return options;
}

TEST(TargetTruth, HasEveryTargetWhileItIsThereInOrderOfTime) {
  const TargetScene scene = make_target_scene(scene_options());
  const std::vector<TargetRow> rows = truth_of(scene, 4.0);
  std::set<std::pair<Timestamp, int>> told;
  Timestamp before = rows.front().time;
  for (const TargetRow& row : rows) {
    const TargetPath& path = scene.paths.at(static_cast<std::size_t>(row.target));
    EXPECT_GE(row.time, before);
    EXPECT_TRUE(row.time >= path.birth && row.time < path.death) << row.target;
    EXPECT_EQ(row.p_world, position_at(path, row.time));
    EXPECT_EQ(row.v_world, velocity_at(path, row.time));
    EXPECT_EQ(row.state, "true");
    EXPECT_TRUE(told.emplace(row.time, row.target).second);
    before = row.time;
  }
  std::size_t expected = 0;
  for (const TargetPath& path : scene.paths) {
    for (Timestamp t{}; t < path.death; t += from_seconds(0.25)) expected += t >= path.birth;
  }
  EXPECT_EQ(rows.size(), expected);
  EXPECT_LT(expected, 3u * 10u * 4u);  // one comes later, or leaves earlier
}

TEST(TargetSimulationSummary, CountsTheFalseBearings) {
  const TargetScene scene = make_target_scene(scene_options());
  const nlohmann::json summary = summary_of(scene_options(), scene);
  std::int64_t false_ones = 0;
  for (const ReceiverReading& reading : scene.readings) false_ones += reading.target < 0;
  EXPECT_GT(false_ones, 0);
  EXPECT_EQ(summary["false_bearings"], false_ones);
  EXPECT_EQ(summary["bearings"], scene.readings.size());
  EXPECT_EQ(summary["truth"], "truth.csv");
  EXPECT_EQ(summary["seed"], 1);
}

TEST(TargetSimulationPicture, ShowsReceiversAndTruePathsWithUpUp) {
  const TargetScene scene = make_target_scene(scene_options());
  const Scene picture = picture_of(scene.receivers, truth_of(scene, 10.0));
  EXPECT_EQ(picture.cameras.size(), 3u);
  EXPECT_EQ(picture.paths.size(), 3u);
  EXPECT_EQ(picture.labels.size(), 3u);
  EXPECT_EQ(picture.legend.size(), 2u);
  EXPECT_TRUE(picture.up_world.isApprox(Eigen::Vector3d::UnitZ()));
}

TEST(TargetSimulationReport, HasSceneAndPlotsAndNamesItsFiles) {
  const TargetScene scene = make_target_scene(scene_options());
  const Report report = report_of(scene_options(), scene, truth_of(scene, 10.0), {"alidade", "simulate"});
  ASSERT_EQ(report.sections.size(), 1u);
  EXPECT_EQ(report.sections[0].figures.size() + report.warnings.size(), 2u);  // no picture: a warning
  EXPECT_EQ(report.links.size(), 3u);
  EXPECT_EQ(report.arguments.size(), 2u);
}

}  // namespace
}  // namespace alidade
