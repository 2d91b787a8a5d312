// SPDX-License-Identifier: Apache-2.0
#include "evaluation/position_error.h"

#include <vector>

#include <gtest/gtest.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

const std::vector<Eigen::Vector3d> kPoints{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {1, 1, 1}};

TEST(RigidErrors, DoNotSeeTheFrame) {
  std::vector<Eigen::Vector3d> moved;
  for (const auto& p : kPoints) moved.emplace_back(exp_so3({0.3, -1.0, 2.0}) * p + Eigen::Vector3d(5, 6, 7));
  const auto errors = rigid_errors(kPoints, moved);
  ASSERT_TRUE(errors);
  EXPECT_LT(errors->distance_m.statistics.max, 1e-12);
  EXPECT_LT((errors->T_truth_estimate * kPoints[2] - moved[2]).norm(), 1e-12);
}

// Twice as large about its mean: every point is off by its own distance from there.
TEST(RigidErrors, SeeTheScale) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : kPoints) mean += p / 5.0;
  std::vector<Eigen::Vector3d> large;
  double sum = 0;
  for (const auto& p : kPoints) {
    large.emplace_back(2.0 * p);
    sum += (p - mean).norm() / 5.0;
  }
  EXPECT_NEAR(rigid_errors(kPoints, large)->distance_m.statistics.mean, sum, 1e-12);
}

TEST(RigidErrors, AreEmptyWithoutThreePoints) {
  const std::vector<Eigen::Vector3d> two{{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(rigid_errors(two, two));
}

}  // namespace
}  // namespace alidade
