// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_picture.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/app/targets/flown_record.h"

namespace alidade {
namespace {

std::vector<TargetRow> truth_of(int targets) {
  std::vector<TargetRow> rows;
  for (int i = 0; i < 4; ++i) {
    for (int target = 1; target <= targets; ++target) rows.push_back(test::row_of(target, i));
  }
  return rows;
}

TEST(TargetScene, ShowsReceiversSightsPathsEllipsoidsAndTruth) {
  const test::TemporaryDirectory folder;
  const TargetRun run = test::flown_record(folder, 2, 30);
  const Scene scene = scene_of(run, truth_of(2));
  EXPECT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.labels.size(), 2u + 2u);
  EXPECT_EQ(scene.paths.size(), 30u + 2u + 2u);   // lines of sight, truth, targets
  EXPECT_EQ(scene.translucent.size(), 2u * 16u);  // ellipsoids
  EXPECT_EQ(scene.legend.size(), 4u);
  EXPECT_TRUE(scene.up_world.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(scene_of(run, {}).paths.size(), 30u + 2u);
  const bool has_last = std::ranges::any_of(scene.labels, [](const SceneLabel& label) {
    return label.text == "2" && label.p_world.isApprox(Eigen::Vector3d(290, 10, 50));
  });
  EXPECT_TRUE(has_last);  // a target's name stands where it was last
}

TEST(TargetScene, CopesWithoutAnyTarget) {
  const test::TemporaryDirectory folder;
  const TargetRun run = test::flown_record(folder, 0, 5);
  EXPECT_EQ(scene_of(run, {}).paths.size(), 0u);
  EXPECT_EQ(scene_of(run, {}).cameras.size(), 2u);
  EXPECT_EQ(plots_of(run, {}).size(), 3u);
}

TEST(TargetScene, NamesTheTargetsThatWereSeenLongestWhereThereAreMany) {
  const test::TemporaryDirectory folder;
  const ResultDirectory directory(folder / "out", "track targets");
  TargetRecord record(directory, test::hill_and_roof());
  for (int target = 1; target <= 12; ++target) {
    for (int i = 0; i <= target; ++i) record.add(test::row_of(target, i));
  }
  const TargetRun run = record.commit();
  const Scene scene = scene_of(run, {});
  std::vector<std::string> names;
  for (const SceneLabel& label : scene.labels) names.push_back(label.text);
  EXPECT_EQ(names, (std::vector<std::string>{"hill", "roof", "5", "6", "7", "8", "9", "10", "11", "12"}));
  EXPECT_EQ(scene.paths.size(), 12u);
}

TEST(TargetPlots, ShowPathsHeightsAndSigmasFromTheFirstBearingOn) {
  const test::TemporaryDirectory folder;
  const TargetRun run = test::flown_record(folder, 2, 30);
  const std::vector<Plot> plots = plots_of(run, truth_of(3));
  ASSERT_EQ(plots.size(), 3u);
  EXPECT_TRUE(plots[0].equal_axes);
  ASSERT_EQ(plots[0].series.size(), 3u + 2u);
  EXPECT_EQ(plots[0].series[0].name, "truth");
  EXPECT_EQ(plots[0].series[1].name, "");
  EXPECT_EQ(plots[0].series[3].name, "target 1");
  EXPECT_EQ(plots[0].series[4].y[7], 10.0);
  const Series& height = plots[1].series.back();
  EXPECT_EQ(height.x[7], 5.0);  // the first bearing is of 2 s
  EXPECT_EQ(height.y[7], 50.0);
  EXPECT_NEAR(plots[2].series.back().y[7], std::sqrt(3 * 0.04), 1e-12);
}

}  // namespace
}  // namespace alidade
