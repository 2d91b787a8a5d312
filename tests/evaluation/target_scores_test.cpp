// SPDX-License-Identifier: Apache-2.0
#include "evaluation/target_scores.h"

#include <chrono>
#include <random>

#include <gtest/gtest.h>

namespace alidade {
namespace {

Timestamp at(int second) {
  return Timestamp(std::chrono::seconds(second));
}

TEST(TargetScores, TellPairsMissesAndFalseOnesApart) {
  TargetMoment both{at(0), {{1, {0, 0, 0}}, {2, {10, 0, 0}}}, {{7, {0, 0, 1}}, {8, {10, 2, 0}}}};
  TargetMoment one{at(1), {{1, {0, 0, 0}}, {2, {10, 0, 0}}}, {{7, {0, 0, 1}}, {9, {50, 0, 0}}, {8, {90, 0, 0}}}};
  const TargetScores scores = score_targets(std::vector{both, one}, 4.0);
  EXPECT_EQ(scores.moments, 2u);
  EXPECT_EQ(scores.pairs, 3u);
  EXPECT_DOUBLE_EQ(scores.rms_m, std::sqrt((1.0 + 4.0 + 1.0) / 3.0));
  EXPECT_DOUBLE_EQ(scores.median_m, 1.0);
  EXPECT_DOUBLE_EQ(scores.localisation_m2, (5.0 + 1.0) / 2.0);
  EXPECT_DOUBLE_EQ(scores.missed_m2, 8.0 / 2.0);
  EXPECT_DOUBLE_EQ(scores.false_m2, 16.0 / 2.0);
  EXPECT_DOUBLE_EQ(scores.gospa_m, (std::sqrt(5.0) + 5.0) / 2.0);
  EXPECT_DOUBLE_EQ(scores.count_right, 0.5);
}

TEST(TargetScores, FindHonestCovariancesConsistent) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 0.3);
  std::vector<TargetMoment> moments;
  for (int i = 0; i < 2000; ++i) {
    const double x = normal(random), y = normal(random), z = normal(random);
    moments.push_back({at(i), {{1, {5, 5, 5}}}, {{1, {5 + x, 5 + y, 5 + z}, 0.09 * Eigen::Matrix3d::Identity()}}});
  }
  const TargetScores scores = score_targets(moments, 4.0);
  EXPECT_GT(scores.nees.mean_per_degree, scores.nees.lower);
  EXPECT_LT(scores.nees.mean_per_degree, scores.nees.upper);
  EXPECT_EQ(scores.identity.switches, 0);
}

TEST(TargetScores, OfNothingAreNothing) {
  const TargetScores scores = score_targets({}, 4.0);
  EXPECT_EQ(scores.moments, 0u);
  EXPECT_EQ(scores.pairs, 0u);
}

}  // namespace
}  // namespace alidade
