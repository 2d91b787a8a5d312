// SPDX-License-Identifier: Apache-2.0
#include "evaluation/gospa.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Positions = std::vector<Eigen::Vector3d>;

constexpr SetMetricOptions kFour{4.0, 2.0};

TEST(Gospa, IsTheDistanceOfOnePair) {
  const Gospa g = gospa(Positions{{0, 0, 0}}, Positions{{1, 2, 2}}, kFour);
  EXPECT_DOUBLE_EQ(g.total_m, 3.0);
  EXPECT_DOUBLE_EQ(g.localisation, 9.0);
  EXPECT_EQ(g.pairs, 1U);
}

// 4² / 2 each: one target beyond the cutoff from the only estimate.
TEST(Gospa, CountsWhatIsTooFarOffAsMissedAndFalse) {
  const Gospa g = gospa(Positions{{0, 0, 0}}, Positions{{5, 0, 0}}, kFour);
  EXPECT_EQ(g.missed, 1U);
  EXPECT_EQ(g.false_ones, 1U);
  EXPECT_DOUBLE_EQ(g.missed_cost, 8.0);
  EXPECT_DOUBLE_EQ(g.false_cost, 8.0);
  EXPECT_DOUBLE_EQ(g.total_m, 4.0);
}

TEST(Gospa, PairsForTheLeastSum) {
  const Positions truth{{0, 0, 0}, {3, 0, 0}}, estimates{{2, 0, 0}, {3.5, 0, 0}};
  EXPECT_DOUBLE_EQ(gospa(truth, estimates, kFour).localisation, 4.0 + 0.25);
}

TEST(Gospa, OfEmptySetsIsNothingAndOfOneEmptySetAllMissed) {
  EXPECT_EQ(gospa(Positions{}, Positions{}, kFour).total_m, 0.0);
  EXPECT_DOUBLE_EQ(gospa(Positions{{1, 0, 0}, {2, 0, 0}}, Positions{}, kFour).total_m, 4.0);
  EXPECT_DOUBLE_EQ(gospa(Positions{}, Positions{{1, 0, 0}, {2, 0, 0}}, kFour).false_cost, 16.0);
}

// It is a metric.
TEST(Gospa, IsSymmetricAndObeysTheTriangle) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 3.0);
  const auto any_set = [&](int size) {
    Positions set;
    for (int i = 0; i < size; ++i) {
      const double x = normal(random), y = normal(random), z = normal(random);
      set.emplace_back(x, y, z);
    }
    return set;
  };
  for (int trial = 0; trial < 300; ++trial) {
    const Positions a = any_set(trial % 4), b = any_set(trial % 5), c = any_set(trial % 3);
    EXPECT_NEAR(gospa(a, b, kFour).total_m, gospa(b, a, kFour).total_m, 1e-12);
    EXPECT_LE(gospa(a, c, kFour).total_m, gospa(a, b, kFour).total_m + gospa(b, c, kFour).total_m + 1e-12);
    EXPECT_NEAR(ospa(a, b, kFour), ospa(b, a, kFour), 1e-12);
    EXPECT_LE(ospa(a, c, kFour), ospa(a, b, kFour) + ospa(b, c, kFour) + 1e-12);
    EXPECT_LE(ospa(a, b, kFour), 4.0 + 1e-12);
  }
}

// Two targets, one of them found 3 m off: ((9 + 16) / 2)^(1/2).
TEST(Ospa, CountsAMissAsTheCutoff) {
  EXPECT_DOUBLE_EQ(ospa(Positions{{0, 0, 0}, {100, 0, 0}}, Positions{{0, 3, 0}}, kFour), std::sqrt(12.5));
  EXPECT_EQ(ospa(Positions{}, Positions{}, kFour), 0.0);
}

TEST(Gospa, RefusesWhatHasNoSense) {
  EXPECT_THROW(gospa(Positions{}, Positions{}, {0.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(gospa(Positions{}, Positions{}, {1.0, 0.5}), std::invalid_argument);
  EXPECT_THROW(gospa(Positions{{std::nan(""), 0, 0}}, Positions{}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
