// SPDX-License-Identifier: Apache-2.0
#include "evaluation/flight_score.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(FlightScore, TakesOutASimilarityAlone) {
  std::vector<PositionPair> pairs;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(10, 0, 0), Eigen::Vector3d(0, 10, 5)}) {
    pairs.push_back({1.1 * p + Eigen::Vector3d(0, 0, 2), p, Eigen::Matrix3d::Zero()});
  }
  const FlightScore score = score_flight(pairs);
  EXPECT_EQ(score.count, 3u);
  EXPECT_NEAR(score.greatest_m, (0.1 * Eigen::Vector3d(0, 10, 5) + Eigen::Vector3d(0, 0, 2)).norm(), 1e-12);
  EXPECT_NEAR(*score.aligned_rmse_m, 0.0, 1e-9);
  EXPECT_FALSE(score.error_per_sigma);
}

TEST(FlightScore, HasTheTheoreticalRatioForNormalErrors) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.2);
  std::vector<PositionPair> pairs(20000);
  for (PositionPair& pair : pairs) {
    pair.estimate = {normal(random), normal(random), normal(random)};
    pair.covariance = 0.04 * Eigen::Matrix3d::Identity();
  }
  EXPECT_NEAR(*score_flight(pairs).error_per_sigma, kTheoreticalErrorPerSigma, 0.01);
}

TEST(FlightScore, IsEmptyOfNothing) {
  const FlightScore score = score_flight({});
  EXPECT_EQ(score.count, 0u);
  EXPECT_FALSE(score.aligned_rmse_m);
}

}  // namespace
}  // namespace alidade
