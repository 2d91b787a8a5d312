// SPDX-License-Identifier: Apache-2.0
#include "evaluation/ensemble.h"

#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

constexpr unsigned kSeed = 83;

TEST(PooledRms, IsTheRootOfTheMeanOfAllSquares) {
  const std::vector<double> mean_squares{1, 4, 10};
  EXPECT_DOUBLE_EQ(pooled_rms(mean_squares), std::sqrt(5.0));
  EXPECT_EQ(pooled_rms({}), 0.0);
}

TEST(RatioOfRms, IsThatOfThePooledSquares) {
  const std::vector<double> mean_squares{1, 2, 3, 6}, reference{8, 16, 8, 16};
  const Ratio ratio = ratio_of_rms(mean_squares, reference);
  EXPECT_DOUBLE_EQ(ratio.value, 0.5);
  EXPECT_LT(ratio.low, ratio.value);
  EXPECT_GT(ratio.high, ratio.value);
}

// The runs are compared in pairs: what makes one run harder for both estimators does not widen the interval.
TEST(RatioOfRms, IsSureWhereAllRunsAgree) {
  const std::vector<double> mean_squares{1, 100, 3, 7}, reference{4, 400, 12, 28};
  const Ratio ratio = ratio_of_rms(mean_squares, reference);
  EXPECT_DOUBLE_EQ(ratio.value, 0.5);
  EXPECT_DOUBLE_EQ(ratio.low, 0.5);
  EXPECT_DOUBLE_EQ(ratio.high, 0.5);
}

// Two estimators of one variance in 100 runs of 20 squares: 95 of 100 intervals hold the true ratio 1, with a standard
// deviation of 1.5 for 200 of them; the bootstrap itself is a little too narrow at 100 runs.
TEST(RatioOfRms, HoldsTheTruthAsOftenAsItSays) {
  std::mt19937_64 random(kSeed);
  std::chi_squared_distribution<double> square(20);
  int held = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> one(100), other(100);
    for (double& value : one) value = square(random) / 20;
    for (double& value : other) value = square(random) / 20;
    const Ratio ratio = ratio_of_rms(one, other);
    if (ratio.low <= 1.0 && 1.0 <= ratio.high) ++held;
  }
  EXPECT_GE(held, 180) << "seed " << kSeed;
  EXPECT_LE(held, 199) << "seed " << kSeed;
}

TEST(RatioOfRms, IsTheSameEveryTime) {
  const std::vector<double> mean_squares{1, 2, 3, 6}, reference{8, 16, 9, 16};
  EXPECT_EQ(ratio_of_rms(mean_squares, reference).low, ratio_of_rms(mean_squares, reference).low);
}

TEST(RatioOfRms, RefusesUnpairedRuns) {
  const std::vector<double> two{1, 2}, three{1, 2, 3};
  EXPECT_THROW(ratio_of_rms(two, three), std::invalid_argument);
  EXPECT_THROW(ratio_of_rms({}, {}), std::invalid_argument);
}

// 23 frames in blocks of 5 make 4 blocks of 5 or 6.
TEST(RatioOfRmsInBlocks, IsThatOfAllFrames) {
  std::vector<double> errors, reference;
  for (int i = 0; i < 23; ++i) {
    errors.push_back(1.0 + 0.1 * i);
    reference.push_back(3.0 - 0.05 * i);
  }
  const auto sum_of_squares = [](const std::vector<double>& values) {
    return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  };
  const Ratio ratio = ratio_of_rms_in_blocks(errors, reference, 5);
  EXPECT_NEAR(ratio.value, std::sqrt(sum_of_squares(errors) / sum_of_squares(reference)), 1e-12);
  EXPECT_LE(ratio.low, ratio.value);
  EXPECT_GE(ratio.high, ratio.value);
}

TEST(RatioOfRmsInBlocks, IsLessSureWhereNeighboursAreAlike) {
  std::vector<double> errors, reference(200, 1.0);
  for (int i = 0; i < 200; ++i) errors.push_back(i / 10 % 2 == 0 ? 1.0 : 3.0);
  const Ratio alone = ratio_of_rms_in_blocks(errors, reference, 1);
  const Ratio in_blocks = ratio_of_rms_in_blocks(errors, reference, 10);
  EXPECT_DOUBLE_EQ(alone.value, in_blocks.value);
  EXPECT_GT(in_blocks.high - in_blocks.low, 2.0 * (alone.high - alone.low));
}

TEST(RatioOfRmsInBlocks, RefusesUnpairedFramesAndEmptyBlocks) {
  const std::vector<double> two{1, 2}, three{1, 2, 3};
  EXPECT_THROW(ratio_of_rms_in_blocks(two, three, 1), std::invalid_argument);
  EXPECT_THROW(ratio_of_rms_in_blocks(two, two, 0), std::invalid_argument);
  EXPECT_THROW(ratio_of_rms_in_blocks({}, {}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
