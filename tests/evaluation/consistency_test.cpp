// SPDX-License-Identifier: Apache-2.0
#include "evaluation/consistency.h"

#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "geometry/alignment.h"
#include "tests/evaluation/paths.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 17;

// Truth = estimate moved by draws from the estimate's covariance, times `boast`.
PairedTrajectories noisy_pairs(int count, double boast) {
  std::mt19937_64 engine(kSeed);
  std::normal_distribution<double> normal;
  Matrix6d A;
  for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = (i % 6 < 3 ? 1e-4 : 1e-5) * normal(engine);
  const Matrix6d P = A * A.transpose();
  PairedTrajectories pairs{test::winding_path(count), {}};
  for (StampedPose& pose : pairs.estimate) {
    pose.covariance = P;
    Vector6d draw;
    for (int i = 0; i < 6; ++i) draw(i) = boast * normal(engine);
    StampedPose truth = pose;
    truth.T_world_camera = pose.T_world_camera * perturbation(A * draw);
    pairs.truth.push_back(truth);
  }
  return pairs;
}

TEST(Consistency, IsWithinItsBoundsForAnHonestCovariance) {
  const auto found = consistency(noisy_pairs(500, 1.0));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->count, 500u);
  EXPECT_GT(found->mean_per_degree, found->lower) << "seed " << kSeed;
  EXPECT_LT(found->mean_per_degree, found->upper) << "seed " << kSeed;
  EXPECT_NEAR(found->upper - found->lower, 2 * 1.96 * std::sqrt(2.0 / 3000), 1e-3);  // normal limit
}

TEST(Consistency, GrowsWithTheSquareOfABoast) {
  const double honest = consistency(noisy_pairs(200, 1.0))->mean_per_degree;
  const auto boastful = consistency(noisy_pairs(200, 2.0));
  EXPECT_NEAR(boastful->mean_per_degree, 4.0 * honest, 1e-3 * honest);
  EXPECT_GT(boastful->mean_per_degree, boastful->upper);
}

// 0.2 m with a standard deviation of 0.1 m is 4; nothing else is off.
TEST(Consistency, IsTheSquareOfTheErrorInSigmas) {
  PairedTrajectories pairs{Trajectory(1), Trajectory(1)};
  pairs.estimate[0].covariance = Vector6d(Vector6d::Constant(0.01)).asDiagonal();
  pairs.truth[0].T_world_camera.translation().z() = 0.2;
  EXPECT_NEAR(*consistency(pairs)->nees[0], 4.0, 1e-12);
  EXPECT_NEAR(consistency(pairs)->mean_per_degree, 4.0 / 6.0, 1e-12);
}

TEST(Consistency, DoesNotDependOnTheUnitOfTheWorld) {
  const PairedTrajectories pairs = noisy_pairs(50, 1.0);
  const Similarity similarity{7.0, test::pose_at_time(0, {1, 2, 3}, {0.3, 0.2, -1}).T_world_camera};
  const PairedTrajectories moved{transform(similarity, pairs.estimate), transform(similarity, pairs.truth)};
  EXPECT_NEAR(consistency(moved)->mean_per_degree, consistency(pairs)->mean_per_degree, 1e-6);
}

TEST(Consistency, LeavesOutPosesWithoutOrWithSingularCovariance) {
  PairedTrajectories pairs = noisy_pairs(4, 1.0);
  pairs.estimate[0].covariance.reset();
  pairs.estimate[1].covariance->setZero();
  *pairs.estimate[2].covariance = Vector6d(Vector6d::Ones()) * Vector6d(Vector6d::Ones()).transpose();
  const auto found = consistency(pairs);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->count, 1u);
  EXPECT_FALSE(found->nees[0] || found->nees[1] || found->nees[2]);
  EXPECT_TRUE(found->nees[3]);
}

TEST(Consistency, IsEmptyWithoutAnyCovariance) {
  EXPECT_FALSE(consistency({test::winding_path(5), test::winding_path(5)}));
}

TEST(Consistency, RefusesUnequalLengths) {
  EXPECT_THROW(consistency({test::winding_path(2), test::winding_path(3)}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
