// SPDX-License-Identifier: Apache-2.0
#include "tracking/map_offset.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/tracking/simulated_motion.h"

namespace alidade {
namespace {

using Eigen::MatrixXd;  // for what is expected: one set of expressions to compile

constexpr unsigned kSeed = 73;

std::vector<PointObservation> uncertain_points(test::RandomGeometry& random, int count) {
  std::vector<PointObservation> observations(static_cast<std::size_t>(count));
  for (PointObservation& o : observations) {
    o.p_world = random.vector() + Eigen::Vector3d(3, -2, 1);
    o.covariance_world = test::random_covariance(random, 3, 0.1);
  }
  return observations;
}

// Where an offset brings a point.
Eigen::Vector3d displaced(const MapOffset& offset, const Vector6d& by, const Eigen::Vector3d& p) {
  return offset.centre_world + exp_so3(by.tail<3>()) * (p - offset.centre_world) + by.head<3>();
}

MatrixXd jacobian(const MapOffset& offset, const Eigen::Vector3d& p) {
  MatrixXd J(3, 6);
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = 1e-6 * Vector6d::Unit(i);
    J.col(i) = (displaced(offset, step, p) - displaced(offset, -step, p)) / 2e-6;
  }
  return J;
}

TEST(RigidOffset, HasTheCovarianceOfTheBestFittingDisplacement) {
  test::RandomGeometry random(kSeed);
  for (const int count : {3, 4, 20}) {
    const auto observations = uncertain_points(random, count);
    const MapOffset offset = rigid_offset(observations);
    MatrixXd information = MatrixXd::Zero(6, 6);
    for (const PointObservation& o : observations) {
      const MatrixXd J = jacobian(offset, o.p_world), W = o.covariance_world.inverse();
      information += J.transpose() * W * J;
    }
    const MatrixXd one = MatrixXd(offset.covariance) * information;
    EXPECT_LT((one - MatrixXd::Identity(6, 6)).cwiseAbs().maxCoeff(), 1e-6) << count << " points, seed " << kSeed;
    EXPECT_TRUE(offset.cross.isZero(0.0));
  }
}

// Four corners of a square of 2 m, each to 0.1 m: their mean to 0.1²/4; about the normal four arms of √2 m, about an
// axis in the plane four of 1 m.
TEST(RigidOffset, IsKnownOfASquare) {
  std::vector<PointObservation> observations(4);
  for (std::size_t i = 0; i < 4; ++i) {
    observations[i].p_world = {i % 2 == 0 ? 4.0 : 6.0, i / 2 == 0 ? 0.0 : 2.0, 7.0};
    observations[i].covariance_world = 0.01 * Eigen::Matrix3d::Identity();
  }
  const MapOffset offset = rigid_offset(observations);
  EXPECT_LT((offset.centre_world - Eigen::Vector3d(5, 1, 7)).norm(), 1e-12);
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(0.01 / 4), 0.01 / 4, 0.01 / 4, 0.01 / 8;
  EXPECT_LT((offset.covariance - Matrix6d(variances.asDiagonal())).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(RigidOffset, IsNoneWhereAPointIsExact) {
  test::RandomGeometry random(kSeed);
  auto observations = uncertain_points(random, 20);
  observations[7].covariance_world.setZero();
  EXPECT_TRUE(rigid_offset(observations).covariance.isZero(0.0));
}

TEST(RigidOffset, IsNoneWhereThePointsDoNotDetermineIt) {
  test::RandomGeometry random(kSeed);
  EXPECT_TRUE(rigid_offset(uncertain_points(random, 2)).covariance.isZero(0.0));
  EXPECT_TRUE(rigid_offset({}).covariance.isZero(0.0));
  for (int trial = 0; trial < 20; ++trial) {
    auto on_a_line = uncertain_points(random, 10);
    const Eigen::Vector3d p = random.vector(), d = random.direction();
    for (PointObservation& o : on_a_line) o.p_world = p + random.normal() * d;
    EXPECT_TRUE(rigid_offset(on_a_line).covariance.isZero(0.0)) << "trial " << trial << ", seed " << kSeed;
  }
}

TEST(ApartFromMapOffset, LeavesCovariances) {
  test::RandomGeometry random(kSeed);
  for (const int count : {3, 4, 20}) {
    const auto observations = uncertain_points(random, count);
    const MapOffset offset = rigid_offset(observations);
    const auto apart = apart_from(offset, observations);
    ASSERT_EQ(apart.size(), observations.size());
    double least = 1e300, taken = 0.0;
    for (std::size_t i = 0; i < apart.size(); ++i) {
      const MatrixXd J = jacobian(offset, observations[i].p_world), covariance = offset.covariance;
      const Eigen::Matrix3d off = observations[i].covariance_world - apart[i].covariance_world;
      EXPECT_LT((off - Eigen::Matrix3d(J * covariance * J.transpose())).norm(), 1e-9);
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(apart[i].covariance_world);
      least = std::min(least, solver.eigenvalues().minCoeff());
      taken += (observations[i].covariance_world.inverse() * off).trace();
      EXPECT_EQ(apart[i].p_world, observations[i].p_world);
    }
    EXPECT_GT(least, -1e-12) << count << " points, seed " << kSeed;
    // Σ tr(P⁻¹ J C Jᵀ) = tr(C Σ JᵀP⁻¹J): as much as six numbers are.
    EXPECT_NEAR(taken, 6.0, 1e-6);
  }
}

// The map lies displaced by a draw of its offset, all along. Over 100 trials the mean NEES of a pose has mean 6 and
// variance 12/100: 99.9 % of means lie within 1.14 of 6.
double mean_nees_of_pose(bool is_considered) {
  constexpr int kTrials = 100;
  double sum = 0.0;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    test::RandomGeometry random(kSeed + trial);
    test::SimulatedCamera simulated = test::simulated_camera(random);
    simulated.noise = {isotropic_noise(0.5, 0.2), isotropic_noise(2.0, 1.0)};
    MotionState belief = test::belief_before_points(0.5);
    const MotionState truth = moved_by(belief, test::drawn(random, belief.covariance));
    auto frames = simulated.recording(truth, 20, random);
    MapOffset offset;
    offset.centre_world = {0.2, -0.1, 0.3};
    offset.covariance = isotropic_noise(0.02, 0.005);
    const Vector6d by = test::drawn(random, offset.covariance);
    // What is seen are points of the truth; the map has them where the offset would have to bring them from.
    for (test::SimulatedFrame& frame : frames) {
      for (PointObservation& o : frame.observations) o.p_world = displaced(offset, -by, o.p_world);
    }
    if (is_considered) belief.map_offset = offset;
    const auto steps = test::filtered(simulated, belief, frames, test::options_as_simulated(simulated.noise));
    if (steps.size() != frames.size()) return -1.0;
    const MotionState& state = steps.back().state;
    const Vector6d off = difference(state.T_world_body, frames.back().truth.T_world_body);
    sum += off.dot(state.covariance.topLeftCorner<6, 6>().ldlt().solve(off));
  }
  return sum / kTrials;
}

TEST(MapOffsetConsistency, HoldsWhereItIsConsidered) {
  EXPECT_NEAR(mean_nees_of_pose(true), 6.0, 1.14) << "seed " << kSeed;
  EXPECT_GT(mean_nees_of_pose(false), 30.0) << "seed " << kSeed;
}

}  // namespace
}  // namespace alidade
