// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_pose.h"

#include <vector>

#include <Eigen/Cholesky>
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "tests/geometry/random_planes.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 22;
constexpr double kSigma_m = 3e-4;
constexpr int kThreeEach[] = {3, 3, 3, 3};
constexpr int kEightEach[] = {8, 8, 8, 8};

Eigen::Isometry3d beside(test::RandomGeometry& random, const Eigen::Isometry3d& T, double rad = 0.02) {
  Vector6d xi;
  xi << random.vector(rad), random.vector(rad);
  return T * perturbation(xi);
}

// Gauss–Newton over the single planes, without any sum.
Eigen::Isometry3d gauss_newton(std::span<const PlaneConstraint> constraints, Eigen::Isometry3d T) {
  for (int step = 0; step < 20; ++step) {
    Matrix6d H = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const PlaneConstraint& c : constraints) {
      const Eigen::Vector3d n_body = T.linear().transpose() * c.plane_world.normal;
      Vector6d J;
      J << n_body, c.p_body.cross(n_body);
      H += c.weight * J * J.transpose();
      gradient += c.weight * distance(c.plane_world, T * c.p_body) * J;
    }
    T = T * perturbation(-H.ldlt().solve(gradient));
  }
  return T;
}

struct PlaneResidual {
  PlaneConstraint constraint;

  template <class T>
  bool operator()(const T* pose, T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q(pose);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> t(pose + 4);
    const Eigen::Matrix<T, 3, 1> p = q * constraint.p_body.cast<T>() + t;
    residual[0] =
        std::sqrt(constraint.weight) * (p.dot(constraint.plane_world.normal.cast<T>()) - constraint.plane_world.offset);
    return true;
  }
};

Eigen::Isometry3d solve_with_ceres(std::span<const PlaneConstraint> constraints, const Eigen::Isometry3d& start) {
  double pose[7];
  Eigen::Map<Eigen::Quaterniond>(pose).coeffs() = Eigen::Quaterniond(start.linear()).coeffs();
  Eigen::Map<Eigen::Vector3d>(pose + 4) = start.translation();
  ceres::Problem problem;
  for (const PlaneConstraint& c : constraints) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PlaneResidual, 1, 7>(new PlaneResidual{c}), nullptr, pose);
  }
  problem.SetManifold(pose, new ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>{});
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-16;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Map<Eigen::Quaterniond>(pose).normalized().toRotationMatrix();
  T.translation() = Eigen::Map<Eigen::Vector3d>(pose + 4);
  return T;
}

TEST(NewtonPose, IsExactForExactPlanes) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Isometry3d truth = random.pose();
    const auto constraints = test::random_planes(random, truth, kEightEach, 0.0);
    const auto found = newton_pose(sum_planes(constraints), beside(random, truth));
    ASSERT_TRUE(found) << trial;
    EXPECT_LT(difference(truth, *found).norm(), 1e-12) << trial << " seed " << kSeed;
  }
}

TEST(NewtonPose, AgreesWithGaussNewtonAndCeres) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Isometry3d truth = random.pose();
    const auto constraints = test::random_planes(random, truth, kThreeEach, kSigma_m);
    const Eigen::Isometry3d start = beside(random, truth);
    const auto found = newton_pose(sum_planes(constraints), start);
    ASSERT_TRUE(found) << trial;
    EXPECT_LT(difference(*found, gauss_newton(constraints, start)).norm(), 1e-8) << trial;
    EXPECT_LT(difference(*found, solve_with_ceres(constraints, start)).norm(), 1e-8) << trial;
  }
}

// What is left after the last step is the square of it, however the planes are weighed.
TEST(NewtonPose, DoesNotDependOnTheScaleOfWeights) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d truth = random.pose(), start = beside(random, truth);
  auto constraints = test::random_planes(random, truth, kThreeEach, kSigma_m);
  const auto found = newton_pose(sum_planes(constraints), start);
  for (PlaneConstraint& c : constraints) c.weight *= 1e-9;
  EXPECT_LT(difference(*found, *newton_pose(sum_planes(constraints), start)).norm(), 1e-10);
}

TEST(NewtonPose, IsEmptyWherePlanesLeaveAPoseOpen) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d truth = random.pose();
  constexpr int kTwoMarkers[] = {4, 4};
  EXPECT_FALSE(newton_pose(sum_planes(test::random_planes(random, truth, kTwoMarkers, 0.0)), truth));
  EXPECT_FALSE(newton_pose(PlaneSums{}, truth));
  auto parallel = test::random_planes(random, truth, kThreeEach, 0.0);
  for (PlaneConstraint& c : parallel) {
    c.plane_world = {Eigen::Vector3d::UnitX(), (truth * c.p_body).x()};
  }
  EXPECT_FALSE(newton_pose(sum_planes(parallel), truth));
}

TEST(DeterminedDirections, CountWhatPlanesTell) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d T = random.pose();
  const auto directions = [&](std::vector<int> planes) {
    return determined_directions(plane_pose_at(test::random_planes(random, T, planes, kSigma_m), T).information);
  };
  EXPECT_EQ(directions({}), 0);
  EXPECT_EQ(directions({1}), 1);
  EXPECT_EQ(directions({8}), 3);
  EXPECT_EQ(directions({4, 4}), 5);  // the rotation about the line through both markers is open
  EXPECT_EQ(directions({1, 1, 1, 1, 1}), 5);
  EXPECT_EQ(directions({2, 2, 2}), 6);
  EXPECT_EQ(directions({1, 1, 1, 1, 1, 1}), 6);
}

// One block of four detectors 3 m away with focal lines at 0, 45, 90, 135° through nearly one point: two markers leave
// a rotation open, three tell all, though the range only weakly.
TEST(DeterminedDirections, CountWhatOneBlockTells) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d T = random.pose(0.1);
  const auto planes_of_block = [&](int markers) {
    std::vector<PlaneConstraint> constraints;
    for (int m = 0; m < markers; ++m) {
      const Eigen::Vector3d p_body = random.vector(0.1);
      for (int detector = 0; detector < 4; ++detector) {
        const Eigen::Vector3d centre(-3, 0.15 * (detector - 1.5), 0);
        const Eigen::Vector3d line = exp_so3({detector * 0.785398, 0, 0}) * Eigen::Vector3d::UnitY();
        const Eigen::Vector3d n = line.cross(T * p_body - centre).normalized();
        constraints.push_back({p_body, {n, n.dot(centre)}, 1e7});
      }
    }
    return constraints;
  };
  EXPECT_EQ(determined_directions(plane_pose_at(planes_of_block(2), T).information), 5);
  EXPECT_EQ(determined_directions(plane_pose_at(planes_of_block(3), T).information), 6);
}

// The mean of 2000 squared normalised errors is 6 ± 0.077 (one sigma).
TEST(PlanePose, HasErrorsAsLargeAsItsInformation) {
  test::RandomGeometry random(kSeed);
  constexpr int kTrials = 2000;
  double nees = 0, chi2_sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Isometry3d truth = random.pose();
    const auto constraints = test::random_planes(random, truth, kThreeEach, kSigma_m);
    const auto found = newton_pose(sum_planes(constraints), truth);
    ASSERT_TRUE(found) << trial;
    const PlanePose pose = plane_pose_at(constraints, *found);
    const Vector6d error = difference(pose.T_world_body, truth);
    nees += error.dot(pose.information * error);
    chi2_sum += pose.chi2;
  }
  EXPECT_NEAR(nees / kTrials, 6.0, 5 * 0.077) << "seed " << kSeed;
  EXPECT_NEAR(chi2_sum / kTrials, 12.0 - 6.0, 5 * 0.077) << "seed " << kSeed;
}

}  // namespace
}  // namespace alidade
