// SPDX-License-Identifier: Apache-2.0
#include "uav/video/dot_fit.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "datasets/drawn_dot.h"

namespace alidade {
namespace {

struct Outcome {
  double nees_per_degree = 0.0, mean_diameter_px = 0.0;
  int fitted = 0;
};

// Of dots on a sloping, noisy ground, from peaks at the nearest pixel.
Outcome fit_many(double size_px, double contrast, int count) {
  cv::RNG random(11);
  Outcome outcome;
  for (int i = 0; i < count; ++i) {
    cv::Mat residual(41, 41, CV_32FC1);
    random.fill(residual, cv::RNG::NORMAL, 0.0, 2.0);
    for (int x = 0; x < 41; ++x) residual.col(x) += 0.3 * x - 5.0;
    const Eigen::Vector2d pixel(20.0 + random.uniform(-0.5, 0.5), 20.0 + random.uniform(-0.5, 0.5));
    draw_dot(residual, {pixel, size_px, contrast}, 0.5);
    const auto dot = fit_dot(residual, {{20, 20}, {20.0, 20.0}, size_px < 3.5 ? 0.85 : 1.4, contrast});
    if (!dot) continue;
    ++outcome.fitted;
    const Eigen::Vector2d error = dot->pixel - pixel;
    outcome.nees_per_degree += 0.5 * error.dot(dot->covariance.inverse() * error);
    outcome.mean_diameter_px += disc_diameter_px(dot->sigma_px, 0.5);
  }
  outcome.nees_per_degree /= outcome.fitted;
  outcome.mean_diameter_px /= outcome.fitted;
  return outcome;
}

TEST(DotFit, ErrsAsItsCovarianceSays) {
  for (const double size : {3.0, 4.0, 6.0}) {
    for (const double contrast : {-16.0, 40.0}) {
      const Outcome outcome = fit_many(size, contrast, 400);
      EXPECT_GT(outcome.fitted, 396) << size << " px, " << contrast;
      // The mean of 800 degrees of freedom lies within 0.9 to 1.1 at 95 %. Discs are no Gaussians: of large, bright
      // ones the misfit is more than the noise, and what is said is on the safe side.
      EXPECT_GT(outcome.nees_per_degree, contrast < 0.0 ? 0.7 : 0.25) << size << " px, " << contrast;
      EXPECT_LT(outcome.nees_per_degree, 1.15) << size << " px, " << contrast;
    }
  }
}

TEST(DotFit, TellsTheDiscsDiameter) {
  for (const double size : {3.0, 4.0, 5.0, 6.0})
    EXPECT_NEAR(fit_many(size, 100.0, 20).mean_diameter_px / size, 1.0, 0.07);
  EXPECT_NEAR(fit_many(2.0, 100.0, 20).mean_diameter_px, 1.7, 0.3);
  EXPECT_EQ(disc_diameter_px(0.3, 0.5), 0.0);
}

TEST(DotFit, IsEmptyWhereThereIsNoDot) {
  cv::Mat flat = cv::Mat::zeros(41, 41, CV_32FC1);
  EXPECT_FALSE(fit_dot(flat, {{20, 20}, {20.0, 20.0}, 1.4, 5.0}));  // no noise either
  cv::RNG random(3);
  cv::Mat edge(41, 41, CV_32FC1);
  random.fill(edge, cv::RNG::NORMAL, 0.0, 1.0);
  for (int x = 21; x < 41; ++x) edge.col(x) += 60.0;
  EXPECT_FALSE(fit_dot(edge, {{21, 20}, {21.0, 20.0}, 1.4, 5.0}));
  cv::Mat dark(41, 41, CV_32FC1);
  random.fill(dark, cv::RNG::NORMAL, 0.0, 1.0);
  draw_dot(dark, {{20.0, 20.0}, 4.0, -30.0});
  EXPECT_FALSE(fit_dot(dark, {{20, 20}, {20.0, 20.0}, 1.4, 5.0}));  // the peak was bright
  EXPECT_TRUE(fit_dot(dark, {{20, 20}, {20.0, 20.0}, 1.4, -5.0}));
}

TEST(DotFit, NamesWhatIsImpossible) {
  DotFitOptions options;
  options.greatest_sigma_px = 0.2;
  EXPECT_THROW(validate(options), std::invalid_argument);
}

TEST(DotFit, WorksAtTheImagesBorder) {
  cv::RNG random(5);
  cv::Mat residual(41, 41, CV_32FC1);
  random.fill(residual, cv::RNG::NORMAL, 0.0, 1.0);
  draw_dot(residual, {{4.2, 38.1}, 4.0, 40.0});
  const auto dot = fit_dot(residual, {{4, 38}, {4.0, 38.0}, 1.4, 9.0});
  ASSERT_TRUE(dot);
  EXPECT_LT((dot->pixel - Eigen::Vector2d(4.2, 38.1)).norm(), 0.3);
}

}  // namespace
}  // namespace alidade
