// SPDX-License-Identifier: Apache-2.0
#include "estimation/motion_noise.h"

#include <cmath>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(IsotropicNoise, HoldsTheVariances) {
  Vector6d variances;
  variances << 4, 4, 4, 0.25, 0.25, 0.25;
  EXPECT_EQ(isotropic_noise(2.0, 0.5), Matrix6d(variances.asDiagonal()));
}

// 0.9 · 4 + 0.1 · 100 = 13.6 and 0.9 · 1 + 0.1 · 25 = 3.4.
TEST(MeanNoise, IsTheCovarianceOfTheMixture) {
  MotionProcess motion(2);
  motion[0] = {{isotropic_noise(2, 1), isotropic_noise(3, 1), isotropic_noise(4, 1)}, 0.9};
  motion[1] = {{isotropic_noise(10, 5), Matrix6d::Zero(), isotropic_noise(4, 1)}, 0.1};
  const MotionNoise mean = mean_noise(motion);
  EXPECT_LT((mean.acceleration - isotropic_noise(std::sqrt(13.6), std::sqrt(3.4))).norm(), 1e-12);
  EXPECT_LT((mean.jerk - 0.9 * motion[0].noise.jerk).norm(), 1e-12);
  EXPECT_LT((mean.jump - motion[0].noise.jump).norm(), 1e-12);
}

TEST(MeanNoise, TakesOtherWeights) {
  const MotionProcess motion{{{isotropic_noise(2, 1)}, 0.9}, {{isotropic_noise(10, 5)}, 0.1}};
  EXPECT_EQ(mean_noise(motion, std::vector<double>{0, 1}).acceleration, motion[1].noise.acceleration);
  EXPECT_TRUE(mean_noise({}).jump.isZero(0.0));
}

}  // namespace
}  // namespace alidade
