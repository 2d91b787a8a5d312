// SPDX-License-Identifier: Apache-2.0
#include "geometry/robust_plane_pose.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/random_planes.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 24;
constexpr double kSigma_m = 3e-4;
constexpr int kEightEach[] = {8, 8, 8, 8};

Eigen::Isometry3d beside(test::RandomGeometry& random, const Eigen::Isometry3d& T, double rad = 0.02) {
  Vector6d xi;
  xi << random.vector(rad), random.vector(rad);
  return T * perturbation(xi);
}

// A wrong plane goes through another marker of the same body.
std::vector<bool> spoil(test::RandomGeometry& random, const Eigen::Isometry3d& truth, double share,
                        std::vector<PlaneConstraint>& constraints) {
  std::vector<bool> is_right(constraints.size(), true);
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    if (random.uniform(0, 1) > share) continue;
    const auto other = static_cast<std::size_t>(random.uniform(0, static_cast<double>(constraints.size()) - 1e-9));
    if (constraints[other].p_body == constraints[i].p_body) continue;
    Plane& plane = constraints[i].plane_world;
    plane.offset = plane.normal.dot(truth * constraints[other].p_body) + random.normal(kSigma_m);
    is_right[i] = false;
  }
  return is_right;
}

TEST(SolveRobustly, IsLeastSquaresWithoutOutliers) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d truth = random.pose();
  auto constraints = test::random_planes(random, truth, kEightEach, kSigma_m);
  for (PlaneConstraint& c : constraints) c.weight *= 0.1;  // all within the gate
  const auto found = solve_robustly(constraints, beside(random, truth));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->inlier_count, 32);
  EXPECT_LT(difference(found->pose.T_world_body, *newton_pose(sum_planes(constraints), truth)).norm(), 1e-9);
}

// From 5 mm and 0.01 rad beside (an extrapolated start is nearer by ten), 30 % of wrong ids. A wrong plane may by
// chance pass within the gate of the right marker; the pose then still is within its noise.
TEST(SolveRobustly, FindsTheRightPlanesAmongWrongOnes) {
  test::RandomGeometry random(kSeed);
  int wrong_poses = 0, right_planes = 0, kept = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Isometry3d truth = random.pose();
    auto constraints = test::random_planes(random, truth, kEightEach, kSigma_m);
    const std::vector<bool> is_right = spoil(random, truth, 0.3, constraints);
    const auto found = solve_robustly(constraints, beside(random, truth, 5e-3));
    ASSERT_TRUE(found) << trial;
    const Vector6d error = difference(found->pose.T_world_body, truth);
    if (error.dot(found->pose.information * error) > 60) ++wrong_poses;
    for (std::size_t i = 0; i < is_right.size(); ++i) {
      right_planes += is_right[i];
      kept += is_right[i] && found->is_inlier[i];
    }
  }
  EXPECT_LE(wrong_poses, 1) << "seed " << kSeed;
  EXPECT_GT(kept, 0.995 * right_planes) << "seed " << kSeed;
}

TEST(SolveRobustly, IsEmptyWhereTooFewFitOrThePoseIsOpen) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d truth = random.pose();
  constexpr int kFive[] = {2, 2, 1}, kTwoMarkers[] = {4, 4};
  EXPECT_FALSE(solve_robustly(test::random_planes(random, truth, kFive, kSigma_m), truth));
  EXPECT_FALSE(solve_robustly(test::random_planes(random, truth, kTwoMarkers, kSigma_m), truth));
  EXPECT_FALSE(solve_robustly({}, truth));
}

TEST(DescendRobustly, EndsWhereNoStepLowersTheRobustCost) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d truth = random.pose();
  auto constraints = test::random_planes(random, truth, kEightEach, kSigma_m);
  spoil(random, truth, 0.2, constraints);
  RobustPlaneOptions options;
  options.max_iterations = 200;
  const auto cost = [&](const Eigen::Isometry3d& T) {
    double sum = 0;
    for (const PlaneConstraint& c : constraints) {
      const double s = c.weight * std::pow(distance(c.plane_world, T * c.p_body), 2);
      sum += options.gate_chi2 * s / (options.gate_chi2 + s);
    }
    return sum;
  };
  const Eigen::Isometry3d found = descend_robustly(constraints, beside(random, truth, 1e-3), options, 1e-9);
  for (int i = 0; i < 6; ++i) {
    for (const double step : {1e-5, -1e-5}) {
      EXPECT_GT(cost(found * perturbation(step * Vector6d::Unit(i))), cost(found)) << i;
    }
  }
}

}  // namespace
}  // namespace alidade
