// SPDX-License-Identifier: Apache-2.0
#include "evaluation/evaluate.h"

#include <gtest/gtest.h>

#include "tests/evaluation/paths.h"

namespace alidade {
namespace {

// The truth as an estimator of another frame and scale would see it.
PairedTrajectories displaced(double scale) {
  const Trajectory truth = test::winding_path(60);
  const Similarity away{scale, test::pose_at_time(0, {4, -1, 2}, {0.4, -0.8, 1.2}).T_world_camera};
  return {transform(away, truth), truth};
}

TEST(Evaluate, FindsNoErrorAfterTheRightAlignment) {
  const auto similar = evaluate(displaced(0.25), {AlignmentKind::Similarity, FrameStep{1}});
  ASSERT_TRUE(similar);
  EXPECT_NEAR(similar->alignment.scale, 4.0, 1e-9);
  EXPECT_LT(similar->absolute.translation_m.statistics.max, 1e-9);
  EXPECT_LT(similar->absolute.rotation_deg.statistics.max, 1e-7);
  EXPECT_LT(similar->relative.translation_m.statistics.max, 1e-9);
  EXPECT_LT(similar->path.translation_percent.statistics.max, 1e-7);
  EXPECT_NEAR(similar->path.path_length_m, path_length(test::winding_path(60)), 1e-12);
  const auto rigid = evaluate(displaced(1.0), {AlignmentKind::Rigid, FrameStep{1}});
  ASSERT_TRUE(rigid);
  EXPECT_LT(rigid->absolute.translation_m.statistics.max, 1e-9);
}

TEST(Evaluate, ShowsTheScaleThatARigidAlignmentLeaves) {
  const auto rigid = evaluate(displaced(1.1), {AlignmentKind::Rigid, FrameStep{1}});
  ASSERT_TRUE(rigid);
  EXPECT_EQ(rigid->alignment.scale, 1.0);
  EXPECT_GT(rigid->absolute.translation_m.statistics.rmse, 0.05);
  EXPECT_LT(rigid->absolute.rotation_deg.statistics.max, 1e-6);
}

TEST(Evaluate, LeavesTheEstimateAloneWithoutAlignment) {
  const PairedTrajectories pairs = displaced(1.0);
  const auto found = evaluate(pairs, {AlignmentKind::None, FrameStep{1}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pairs.estimate[7].T_world_camera.matrix(), pairs.estimate[7].T_world_camera.matrix());
  EXPECT_GT(found->absolute.translation_m.statistics.min, 0.5);
}

TEST(Evaluate, JudgesCovariancesInTheFrameOfTheTruth) {
  PairedTrajectories pairs = displaced(0.25);
  for (StampedPose& pose : pairs.estimate) pose.covariance = 1e-4 * Matrix6d::Identity();
  pairs.truth[30].T_world_camera.translation() += Eigen::Vector3d(0, 0, 0.08);
  const auto found = evaluate(pairs);
  ASSERT_TRUE(found && found->consistency);
  EXPECT_EQ(found->consistency->count, 60u);
  // 0.08 m of the truth is 0.02 of the estimate, two of its sigmas, less what the alignment takes up.
  EXPECT_NEAR(*found->consistency->nees[30], 4.0, 0.5);
}

TEST(Evaluate, IsEmptyWhereNoAlignmentIsDetermined) {
  Trajectory line;
  for (int i = 0; i < 10; ++i) line.push_back(test::pose_at_time(i, {1.0 * i, 2.0 * i, 0}));
  EXPECT_FALSE(evaluate({line, line}));
  EXPECT_TRUE(evaluate({line, line}, {AlignmentKind::None, FrameStep{1}}));
  EXPECT_FALSE(evaluate({}));
}

}  // namespace
}  // namespace alidade
