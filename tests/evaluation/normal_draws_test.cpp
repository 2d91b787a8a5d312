// SPDX-License-Identifier: Apache-2.0
#include "evaluation/normal_draws.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(MatchedNormalDraws, HaveTheMomentsExactly) {
  const Eigen::MatrixXd draws = matched_normal_draws(200, 30, 3);
  EXPECT_LT(draws.colwise().mean().cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_TRUE((draws.transpose() * draws / 200.0).isIdentity(1e-10));
}

// Of a normal variable, the fourth moment is 3.
TEST(MatchedNormalDraws, AreNearlyNormal) {
  const Eigen::MatrixXd draws = matched_normal_draws(5000, 10, 4);
  EXPECT_NEAR(draws.array().pow(4).mean(), 3.0, 0.15);
}

TEST(MatchedNormalDraws, DifferBySeed) {
  EXPECT_TRUE(matched_normal_draws(50, 4, 1).isApprox(matched_normal_draws(50, 4, 1)));
  EXPECT_FALSE(matched_normal_draws(50, 4, 1).isApprox(matched_normal_draws(50, 4, 2)));
}

TEST(MatchedNormalDraws, NeedMoreRunsThanDimensions) {
  EXPECT_THROW(matched_normal_draws(5, 4, 1), std::invalid_argument);
  EXPECT_THROW(matched_normal_draws(5, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
