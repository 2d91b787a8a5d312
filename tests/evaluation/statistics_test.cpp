// SPDX-License-Identifier: Apache-2.0
#include "evaluation/statistics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace alidade {
namespace {

// 1, 2, 3, 6: mean 3, squares 50 / 4, deviations 4 + 1 + 0 + 9 = 14 over 4.
TEST(Summarise, ComputesEachStatistic) {
  const Statistics s = summarise({6, 1, 3, 2});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(3.5));
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_EQ(s.min, 1.0);
  EXPECT_EQ(s.max, 6.0);
}

TEST(Summarise, TakesTheMiddleOfAnOddCountAsMedian) {
  EXPECT_EQ(summarise({9, 1, 4}).median, 4.0);
}

TEST(Summarise, IsZeroForNothing) {
  const Statistics s = summarise({});
  EXPECT_EQ(s.count, 0u);
  EXPECT_EQ(s.rmse, 0.0);
}

TEST(WithStatistics, KeepsTheOrderOfTheErrors) {
  const ErrorSeries series = with_statistics({3, 1, 2});
  EXPECT_EQ(series.values, (std::vector<double>{3, 1, 2}));
  EXPECT_EQ(series.statistics.max, 3.0);
}

}  // namespace
}  // namespace alidade
