// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_valley.h"

#include <array>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "geometry/plane_pose_minima.h"
#include "tests/geometry/random_planes.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 41;
constexpr double kSigma_m = 3e-4;

// Two planes of each of three markers have two or four exact poses; noise merges two of them now and then.
TEST(FollowValley, HoldsTheTruthWhereTwoPosesMerged) {
  test::RandomGeometry random(kSeed);
  int merged = 0, far = 0;
  double nees = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Eigen::Isometry3d truth = random.pose();
    const std::vector<PlaneConstraint> constraints = test::random_planes(random, truth, std::array{2, 2, 2}, kSigma_m);
    for (const PlanePose& minimum : all_minima(constraints)) {
      const bool is_near = difference(minimum.T_world_body, truth).norm() < 0.2;
      if (!is_near || minimum.chi2 > 10.0 || determined_directions(minimum.information) != 5) continue;
      const auto valley = follow_valley(constraints, minimum);
      if (!valley) continue;  // longer than half a radian
      ++merged;
      const Vector6d error = difference(valley->T_world_body, truth);
      const double chi2 = error.dot(valley->covariance.llt().solve(error));
      far += chi2 > 40.0;
      nees += chi2 / 6;
      EXPECT_LT(valley->covariance.trace(), 0.5 * 0.5) << trial;
    }
  }
  EXPECT_GE(merged, 150) << "seed " << kSeed;
  EXPECT_LT(far, 0.03 * merged);  // the valley bends, its ends are far from its mean
  EXPECT_NEAR(nees / merged, 1.0, 0.5);
}

TEST(FollowValley, IsForOneOpenDirectionOnly) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d truth = random.pose();
  const std::vector<PlaneConstraint> sharp = test::random_planes(random, truth, std::array{4, 4, 4}, kSigma_m);
  EXPECT_FALSE(follow_valley(sharp, plane_pose_at(sharp, truth)).has_value());
  const std::vector<PlaneConstraint> endless =
      test::random_planes(random, truth, std::array{4, 4}, 0.0);  // two markers: a hinge
  EXPECT_FALSE(follow_valley(endless, plane_pose_at(endless, truth)).has_value());
}

}  // namespace
}  // namespace alidade
