// SPDX-License-Identifier: Apache-2.0
#include "estimation/assignment.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Pairs = std::vector<std::optional<Index>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double gain_of(const MatrixXd& gain, const Pairs& pairs) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i]) sum += gain(static_cast<Index>(i), *pairs[i]);
  }
  return sum;
}

// All ways, row after row.
double most(const MatrixXd& gain, Index row, std::vector<bool>& is_taken) {
  if (row == gain.rows()) return 0.0;
  double best = most(gain, row + 1, is_taken);
  for (Index j = 0; j < gain.cols(); ++j) {
    if (is_taken[static_cast<std::size_t>(j)]) continue;
    is_taken[static_cast<std::size_t>(j)] = true;
    best = std::max(best, gain(row, j) + most(gain, row + 1, is_taken));
    is_taken[static_cast<std::size_t>(j)] = false;
  }
  return best;
}

TEST(BestAssignment, GivesUpTheBestPairForABetterSum) {
  MatrixXd gain(2, 2);
  gain << 10, 9, 8, 1;
  EXPECT_EQ(best_assignment(gain), (Pairs{1, 0}));
}

TEST(BestAssignment, LeavesAloneWhatGainsNothing) {
  MatrixXd gain(2, 3);
  gain << -1, 0, -kInfinity, -kInfinity, 2, 3;
  EXPECT_EQ(best_assignment(gain), (Pairs{std::nullopt, 2}));
}

TEST(BestAssignment, HasNothingToPairInAnEmptyMatrix) {
  EXPECT_TRUE(best_assignment(MatrixXd(0, 3)).empty());
  EXPECT_EQ(best_assignment(MatrixXd(2, 0)), (Pairs{std::nullopt, std::nullopt}));
}

TEST(BestAssignment, IsTheBestOfAllWays) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.5, 1.0);
  std::bernoulli_distribution is_forbidden(0.2);
  for (int trial = 0; trial < 600; ++trial) {
    MatrixXd gain(1 + trial % 6, 1 + (trial / 6) % 6);
    for (double& g : gain.reshaped()) g = is_forbidden(random) ? -kInfinity : normal(random);
    std::vector<bool> is_taken(static_cast<std::size_t>(gain.cols()), false);
    EXPECT_NEAR(gain_of(gain, best_assignment(gain)), most(gain, 0, is_taken), 1e-12) << "trial " << trial;
  }
}

TEST(BestAssignment, UsesNoColumnTwice) {
  const Pairs pairs = best_assignment(MatrixXd::Ones(40, 25));
  std::vector<Index> columns;
  for (const auto& column : pairs) {
    if (column) columns.push_back(*column);
  }
  std::sort(columns.begin(), columns.end());
  std::vector<Index> all(25);
  std::iota(all.begin(), all.end(), Index{0});
  EXPECT_EQ(columns, all);
}

TEST(BestAssignment, RefusesWhatHasNoOrder) {
  EXPECT_THROW(best_assignment(MatrixXd::Constant(1, 1, std::nan(""))), std::invalid_argument);
  EXPECT_THROW(best_assignment(MatrixXd::Constant(1, 1, kInfinity)), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
