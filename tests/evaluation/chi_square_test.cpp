// SPDX-License-Identifier: Apache-2.0
#include "evaluation/chi_square.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

// Two degrees of freedom: P(x) = 1 - exp(-x / 2).
TEST(ChiSquareQuantile, IsExactForTwoDegrees) {
  for (double p : {1e-6, 0.025, 0.5, 0.95, 0.999999}) {
    EXPECT_NEAR(chi_square_quantile(2, p), -2.0 * std::log1p(-p), 1e-8) << p;
  }
}

// Abramowitz and Stegun, table 26.8.
TEST(ChiSquareQuantile, AgreesWithTheTables) {
  EXPECT_NEAR(chi_square_quantile(1, 0.95), 3.84146, 1e-5);
  EXPECT_NEAR(chi_square_quantile(6, 0.975), 14.4494, 1e-4);
  EXPECT_NEAR(chi_square_quantile(6, 0.025), 1.237347, 1e-5);
  EXPECT_NEAR(chi_square_quantile(100, 0.95), 124.342, 1e-3);
}

// Wilson and Hilferty's cube is good to 1e-6 at thousands of degrees.
TEST(ChiSquareQuantile, HoldsForManyDegrees) {
  const double n = 60000, c = 2.0 / (9.0 * n);
  EXPECT_NEAR(chi_square_quantile(n, 0.975) / n, std::pow(1 - c + 1.9599639845 * std::sqrt(c), 3), 1e-6);
}

TEST(ChiSquareQuantile, RefusesWhatIsNoProbability) {
  EXPECT_THROW(chi_square_quantile(0, 0.5), std::invalid_argument);
  EXPECT_THROW(chi_square_quantile(6, 0.0), std::invalid_argument);
  EXPECT_THROW(chi_square_quantile(6, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
