// SPDX-License-Identifier: Apache-2.0
#include "uav/video/dot_filter.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "datasets/drawn_dot.h"

namespace alidade {
namespace {

// Frames of noise of 2 grey levels, at which a filter has looked `frames` times.
class Noise {
 public:
  explicit Noise(cv::Size size) : size_(size), random_(7) {}
  cv::Mat next(double sigma = 2.0) {
    cv::Mat residual(size_, CV_32FC1);
    random_.fill(residual, cv::RNG::NORMAL, 0.0, sigma);
    return residual;
  }

 private:
  cv::Size size_;
  cv::RNG random_;
};

TEST(DotFilter, PassesNoiseAsRarelyAsANormalVariableDoes) {
  DotFilterOptions options;
  options.threshold = 3.5;
  Noise noise({300, 200});
  DotFilter filter(options);
  for (int i = 0; i < 60; ++i) filter.find(noise.next());
  double peaks = 0.0;
  for (int i = 0; i < 40; ++i) peaks += static_cast<double>(filter.find(noise.next()).size()) / 40.0;
  // 53,000 pixels and P(|z| > 3.5) = 0.00047 are 25 at each of two scales, were the responses independent; a peak
  // comprises about three pixels of the finer one and eight of the coarser, and a learnt variance errs by a tenth.
  EXPECT_GT(peaks, 4.0);
  EXPECT_LT(peaks, 25.0);
}

TEST(DotFilter, FindsDarkAndBrightDotsOfAllSizesWithTheScaleThatFits) {
  Noise noise({200, 200});
  DotFilter filter;
  for (int i = 0; i < 50; ++i) filter.find(noise.next());
  for (const double size : {2.5, 6.0}) {
    for (const double contrast : {-20.0, 20.0}) {
      cv::Mat residual = noise.next();
      draw_dot(residual, {{100.3, 90.6}, size, contrast}, 0.5);
      const auto peaks = filter.find(residual);
      const auto strongest = *std::max_element(peaks.begin(), peaks.end(), [](const auto& a, const auto& b) {
        return std::abs(a.response) < std::abs(b.response);
      });
      EXPECT_LT(std::hypot(strongest.summit.x - 100.3, strongest.summit.y - 90.6), 0.6) << size;
      EXPECT_GT(strongest.response * contrast, 0.0) << size;
      EXPECT_GT(std::abs(strongest.response), 8.0) << size;
      EXPECT_EQ(strongest.sigma_px, size < 3.0 ? 0.85 : 1.4);
    }
  }
}

TEST(DotFilter, LearnsThePixelsThatFlicker) {
  Noise noise({100, 100});
  DotFilter filter;
  double last = 0.0;
  for (int i = 0; i < 120; ++i) {
    cv::Mat residual = noise.next();
    draw_dot(residual, {{50.0, 50.0}, 4.0, i % 2 == 0 ? 15.0 : -15.0});
    last = 0.0;
    for (const DotPeak& peak : filter.find(residual)) {
      if (std::abs(peak.pixel.x - 50) < 3 && std::abs(peak.pixel.y - 50) < 3) last = std::abs(peak.response);
    }
  }
  EXPECT_LT(last, 3.5);
}

TEST(DotFilter, AsksMoreWhereTheSurroundIsSuddenlyNoisy) {
  Noise noise({200, 200});
  DotFilter filter;
  for (int i = 0; i < 60; ++i) filter.find(noise.next());
  const std::size_t quiet = filter.find(noise.next()).size();
  EXPECT_LT(filter.find(noise.next(5.0)).size(), 4 * quiet);  // by the learnt noise alone 25 % of the pixels would pass
}

TEST(DotFilter, IsNotMovedBySlowWavesOfBrightness) {
  Noise noise({200, 200});
  DotFilter filter;
  for (int i = 0; i < 60; ++i) filter.find(noise.next());
  cv::Mat residual = noise.next();
  const std::size_t quiet = filter.find(residual.clone()).size();
  for (int y = 0; y < residual.rows; ++y) {
    for (int x = 0; x < residual.cols; ++x) residual.at<float>(y, x) += static_cast<float>(10.0 * std::sin(0.04 * x));
  }
  EXPECT_LT(filter.find(residual).size(), quiet + 15);
}

TEST(DotFilter, NamesWhatIsImpossible) {
  DotFilterOptions options;
  options.surround_px = 14;
  EXPECT_THROW(DotFilter{options}, std::invalid_argument);
  DotFilter filter;
  EXPECT_THROW(filter.find(cv::Mat::zeros(50, 50, CV_8UC1)), std::invalid_argument);
  filter.find(cv::Mat::zeros(50, 50, CV_32FC1));
  EXPECT_THROW(filter.find(cv::Mat::zeros(50, 60, CV_32FC1)), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
