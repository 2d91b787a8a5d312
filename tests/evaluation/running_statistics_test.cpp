// SPDX-License-Identifier: Apache-2.0
#include "evaluation/running_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "evaluation/statistics.h"

namespace alidade {
namespace {

TEST(RunningStatistics, AgreesWithTheWholeList) {
  std::mt19937 random(1);
  for (const double scale : {1e-6, 1.0, 3e4}) {
    std::normal_distribution<double> normal(0.3 * scale, scale);
    RunningStatistics running;
    std::vector<double> values, magnitudes;
    for (int i = 0; i < 10'001; ++i) {
      values.push_back(normal(random));
      magnitudes.push_back(std::abs(values.back()));
      running.add(values.back());
    }
    const Statistics whole = summarise(values);
    EXPECT_EQ(running.count(), 10'001);
    EXPECT_NEAR(running.mean(), whole.mean, 1e-9 * scale);
    EXPECT_NEAR(running.rms(), whole.rmse, 1e-9 * scale);
    EXPECT_NEAR(running.median_magnitude() / summarise(magnitudes).median, 1.0, 0.01);
    EXPECT_EQ(running.largest_magnitude(), *std::max_element(magnitudes.begin(), magnitudes.end()));
  }
}

TEST(RunningStatistics, IsZeroWithoutValuesAndOfZeros) {
  RunningStatistics running;
  EXPECT_EQ(running.rms(), 0.0);
  EXPECT_EQ(running.mean(), 0.0);
  EXPECT_EQ(running.median_magnitude(), 0.0);
  running.add(0.0);
  EXPECT_EQ(running.median_magnitude(), 0.0);
}

TEST(RunningStatistics, RefusesWhatIsNotFinite) {
  RunningStatistics running;
  EXPECT_THROW(running.add(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(running.add(std::numeric_limits<double>::infinity()), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
