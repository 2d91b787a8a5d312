// SPDX-License-Identifier: Apache-2.0
#include "view/axis_ticks.h"

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::vector<std::string> texts(const std::vector<Tick>& ticks) {
  std::vector<std::string> out;
  for (const auto& tick : ticks) out.push_back(tick.text);
  return out;
}

TEST(LinearTicks, AreRoundAndPrintedAlike) {
  EXPECT_EQ(texts(linear_ticks(0, 1, 5)), (std::vector<std::string>{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(texts(linear_ticks(-7, 12, 4)), (std::vector<std::string>{"-5", "0", "5", "10"}));
  EXPECT_EQ(texts(linear_ticks(3.1e-6, 5.2e-6, 2)), (std::vector<std::string>{"4e-06", "5e-06"}));
}

TEST(LinearTicks, TellNeighboursApartFarFromZero) {
  const auto ticks = texts(linear_ticks(1305031229.2, 1305031231.9, 5));
  EXPECT_EQ(std::set<std::string>(ticks.begin(), ticks.end()).size(), ticks.size());
}

TEST(LinearTicks, LieInsideAndAreAboutAsManyAsWanted) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-8, 8), at(-1, 1);
  for (int trial = 0; trial < 500; ++trial) {
    const double low = at(random) * std::pow(10, exponent(random)), high = low + std::pow(10, exponent(random));
    if (!(high - low > 1e-9 * std::abs(low))) continue;
    const auto ticks = linear_ticks(low, high, 6);
    EXPECT_GE(ticks.size(), 3u) << low << " " << high;
    EXPECT_LE(ticks.size(), 11u) << low << " " << high;
    const double slack = 1e-6 * (high - low);
    for (const auto& tick : ticks) EXPECT_TRUE(tick.value >= low - slack && tick.value <= high + slack);
  }
}

TEST(LogarithmicTicks, ArePowersOfTenOrFinerWhereThereAreTooFew) {
  EXPECT_EQ(texts(logarithmic_ticks(0.003, 200, 6)), (std::vector<std::string>{"0.01", "0.1", "1", "10", "100"}));
  EXPECT_EQ(texts(logarithmic_ticks(0.003, 200, 3)), (std::vector<std::string>{"0.01", "1", "100"}));
  EXPECT_EQ(texts(logarithmic_ticks(3, 30, 6)), (std::vector<std::string>{"5", "10", "20"}));
  EXPECT_EQ(texts(logarithmic_ticks(0.61, 0.66, 3)), (std::vector<std::string>{"0.62", "0.64", "0.66"}));
}

TEST(Ticks, RefuseAnEmptyOrImpossibleRange) {
  EXPECT_THROW(linear_ticks(1, 1, 5), std::invalid_argument);
  EXPECT_THROW(linear_ticks(0, std::numeric_limits<double>::infinity(), 5), std::invalid_argument);
  EXPECT_THROW(linear_ticks(std::nan(""), 1, 5), std::invalid_argument);
  EXPECT_THROW(logarithmic_ticks(0, 1, 5), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
