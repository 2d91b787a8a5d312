// SPDX-License-Identifier: Apache-2.0
#include "uav/target_state.h"

#include <chrono>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TargetState flying() {
  TargetState state;
  state.p_world = {1, 2, 3};
  state.v_world = {4, -5, 6};
  state.a_world = {-1, 0.5, 2};
  const Matrix9d A = Matrix9d::Random();
  state.covariance = A * A.transpose();
  return state;
}

TEST(TargetState, MovesAlongAParabola) {
  const TargetState moved = moved_to(flying(), Timestamp(std::chrono::seconds(2)));
  EXPECT_TRUE(moved.p_world.isApprox(Eigen::Vector3d(1 + 8 - 2, 2 - 10 + 1, 3 + 12 + 4)));
  EXPECT_TRUE(moved.v_world.isApprox(Eigen::Vector3d(2, -4, 10)));
}

TEST(TargetState, ComesBackWithItsCovariance) {
  const TargetState state = flying();
  const TargetState back = moved_to(moved_to(state, Timestamp(std::chrono::seconds(3))), state.time);
  EXPECT_TRUE(back.p_world.isApprox(state.p_world));
  EXPECT_TRUE(back.covariance.isApprox(state.covariance, 1e-9));
}

TEST(TargetState, GrowsLessSureOfAPlaceThanOfItsPace) {
  TargetState state;
  state.covariance.diagonal() << 1, 1, 1, 4, 4, 4, 0, 0, 0;
  const TargetState moved = moved_to(state, Timestamp(std::chrono::seconds(3)));
  EXPECT_DOUBLE_EQ(moved.covariance(0, 0), 1 + 9 * 4);
  EXPECT_DOUBLE_EQ(moved.covariance(0, 3), 3 * 4);
  EXPECT_DOUBLE_EQ(moved.covariance(3, 3), 4);
}

}  // namespace
}  // namespace alidade
