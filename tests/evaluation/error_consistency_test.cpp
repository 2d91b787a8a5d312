// SPDX-License-Identifier: Apache-2.0
#include "evaluation/error_consistency.h"

#include <cmath>
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

// Of 400 means, 95 % ± 4 standard deviations lie within the bounds; half as large a covariance is always found out.
TEST(ErrorConsistency, HoldsItsBoundsForNormalErrors) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 0.5);
  constexpr int kMeans = 400, kErrors = 100;
  int within = 0;
  for (int mean = 0; mean < kMeans; ++mean) {
    ErrorConsistencyTally honest, boastful;
    for (int i = 0; i < kErrors; ++i) {
      const double x = normal(random), y = normal(random), z = normal(random);
      honest.add(Eigen::Vector3d(x, y, z), 0.25 * Eigen::Matrix3d::Identity());
      boastful.add(Eigen::Vector3d(x, y, z), 0.125 * Eigen::Matrix3d::Identity());
    }
    const ErrorConsistency result = honest.result();
    within += result.lower < result.mean_per_degree && result.mean_per_degree < result.upper;
    EXPECT_GT(boastful.result().mean_per_degree, boastful.result().upper);
  }
  EXPECT_NEAR(within, 0.95 * kMeans, 4.0 * std::sqrt(0.95 * 0.05 * kMeans));
}

TEST(ErrorConsistency, RefusesACovarianceThatIsNone) {
  ErrorConsistencyTally tally;
  EXPECT_THROW(tally.add(Eigen::Vector2d(1, 1), Eigen::Matrix2d::Zero()), std::invalid_argument);
  EXPECT_THROW(tally.add(Eigen::Vector3d(1, 1, 1), Eigen::Matrix2d::Identity()), std::invalid_argument);
  EXPECT_EQ(tally.result().count, 0U);
}

}  // namespace
}  // namespace alidade
