// SPDX-License-Identifier: Apache-2.0
#include "evaluation/error_consistency.h"

#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(ErrorConsistency, NormalisesByTheCovariance) {
  ErrorConsistencyTally tally;
  tally.add(Eigen::Vector2d(2, 3), Eigen::Vector2d(4, 9).asDiagonal().toDenseMatrix());
  EXPECT_DOUBLE_EQ(tally.result().mean_per_degree, 1.0);
  EXPECT_EQ(tally.result().count, 1U);
}

// Of 2000 normal errors the mean lies within the bounds, and half as large a covariance is found out.
TEST(ErrorConsistency, HoldsBoundsForNormalErrors) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 0.5);
  ErrorConsistencyTally honest, boastful;
  for (int i = 0; i < 2000; ++i) {
    const double x = normal(random), y = normal(random), z = normal(random);
    honest.add(Eigen::Vector3d(x, y, z), 0.25 * Eigen::Matrix3d::Identity());
    boastful.add(Eigen::Vector3d(x, y, z), 0.125 * Eigen::Matrix3d::Identity());
  }
  const ErrorConsistency result = honest.result();
  EXPECT_LT(result.lower, result.mean_per_degree);
  EXPECT_GT(result.upper, result.mean_per_degree);
  EXPECT_NEAR(result.upper - result.lower, 2 * 1.96 * std::sqrt(2.0 / 6000), 0.005);
  EXPECT_GT(boastful.result().mean_per_degree, boastful.result().upper);
}

TEST(ErrorConsistency, RefusesACovarianceThatIsNone) {
  ErrorConsistencyTally tally;
  EXPECT_THROW(tally.add(Eigen::Vector2d(1, 1), Eigen::Matrix2d::Zero()), std::invalid_argument);
  EXPECT_THROW(tally.add(Eigen::Vector3d(1, 1, 1), Eigen::Matrix2d::Identity()), std::invalid_argument);
  EXPECT_EQ(tally.result().count, 0U);
}

}  // namespace
}  // namespace alidade
