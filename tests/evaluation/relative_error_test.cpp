// SPDX-License-Identifier: Apache-2.0
#include "evaluation/relative_error.h"

#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/evaluation/paths.h"

namespace alidade {
namespace {

// Centres at 0, 1, 2, 4, 8 m and 0, 1, 2, 3, 4 s.
Trajectory straight() {
  Trajectory path;
  for (double x : {0.0, 1.0, 2.0, 4.0, 8.0}) {
    path.push_back(test::pose_at_time(static_cast<double>(path.size()), {x, 0, 0}));
  }
  return path;
}

std::vector<std::pair<std::size_t, std::size_t>> list(const std::vector<PoseSpan>& found) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const PoseSpan& span : found) pairs.emplace_back(span.first, span.last);
  return pairs;
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(Spans, ReachTheFirstPoseAStepAway) {
  EXPECT_EQ(list(spans(straight(), FrameStep{1})), (Pairs{{0, 1}, {1, 2}, {2, 3}, {3, 4}}));
  EXPECT_EQ(list(spans(straight(), FrameStep{3})), (Pairs{{0, 3}, {1, 4}}));
  EXPECT_EQ(list(spans(straight(), PathStep{2.0})), (Pairs{{0, 2}, {1, 3}, {2, 3}, {3, 4}}));
  EXPECT_EQ(list(spans(straight(), PathStep{6.5})), (Pairs{{0, 4}, {1, 4}}));
  EXPECT_EQ(list(spans(straight(), TimeStep{2.0})), (Pairs{{0, 2}, {1, 3}, {2, 4}}));
}

TEST(Spans, AreNoneWhereThePathIsShorterThanTheStep) {
  EXPECT_TRUE(spans(straight(), PathStep{8.1}).empty());
  EXPECT_TRUE(spans(straight(), FrameStep{5}).empty());
  EXPECT_TRUE(spans({}, FrameStep{1}).empty());
}

TEST(Spans, RefuseAStepThatIsNotPositive) {
  EXPECT_THROW(spans(straight(), FrameStep{0}), std::invalid_argument);
  EXPECT_THROW(spans(straight(), PathStep{-1.0}), std::invalid_argument);
  EXPECT_THROW(spans(straight(), TimeStep{std::nan("")}), std::invalid_argument);
}

TEST(RelativeErrors, DoNotSeeTheFrameOfTheEstimate) {
  const Trajectory truth = test::winding_path(20);
  Trajectory estimate = truth;
  const Eigen::Isometry3d T = test::pose_at_time(0, {5, -3, 2}, {0.5, 1.0, -2.0}).T_world_camera;
  for (StampedPose& pose : estimate) pose.T_world_camera = T * pose.T_world_camera;
  const RelativeErrors errors = relative_errors({estimate, truth}, FrameStep{1});
  ASSERT_EQ(errors.translation_m.values.size(), 19u);
  EXPECT_LT(errors.translation_m.statistics.max, 1e-12);
  EXPECT_LT(errors.rotation_deg.statistics.max, 1e-10);
}

// One wrong step: half a metre too far and a hundredth of a radian too much, and right again after it.
TEST(RelativeErrors, ShowAJumpOnceWhereItIs) {
  const Trajectory truth = test::winding_path(10);
  Trajectory estimate = truth;
  Vector6d jump;
  jump << 0, 0, 0.5, 0.01, 0, 0;
  const Eigen::Isometry3d T_new_old = truth[4].T_world_camera * perturbation(jump) * truth[4].T_world_camera.inverse();
  for (std::size_t i = 4; i < estimate.size(); ++i) {
    estimate[i].T_world_camera = T_new_old * truth[i].T_world_camera;
  }
  const RelativeErrors errors = relative_errors({estimate, truth}, FrameStep{1});
  for (std::size_t i = 0; i < errors.spans.size(); ++i) {
    const bool jumped = errors.spans[i].last == 4;
    EXPECT_NEAR(errors.translation_m.values[i], jumped ? 0.5 : 0.0, 1e-12) << i;
    EXPECT_NEAR(errors.rotation_deg.values[i], jumped ? 0.01 * 180 / std::numbers::pi : 0.0, 1e-10) << i;
  }
}

TEST(RelativeErrors, RefuseUnequalLengths) {
  EXPECT_THROW(relative_errors({test::winding_path(2), test::winding_path(3)}, FrameStep{1}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
