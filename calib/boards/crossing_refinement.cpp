// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/crossing_refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

using Eigen::Vector2d;

struct RefinedCorner {
  Vector2d pixel;
  double sigma_px;
};

// Standard deviation of the image's noise, grey levels; at least that of the rounding to whole ones. The filter is
// blind to planes and edges along the axes. Source: Immerkaer, Fast noise variance estimation, CVIU 1996, with the
// median.
double noise_of(const cv::Mat& grey) {
  constexpr double kRounding = 0.29, kGain = 6.0, kMedianOfNormal = 0.6745;
  const cv::Matx33f kernel(1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat filtered;
  cv::filter2D(grey, filtered, CV_32F, kernel);
  std::vector<float> sizes;
  for (int y = 1; y + 1 < filtered.rows; y += 3) {
    for (int x = 1; x + 1 < filtered.cols; x += 3) {
      // A clipped pixel has no noise to tell.
      if (grey.at<unsigned char>(y, x) > 0 && grey.at<unsigned char>(y, x) < 255) {
        sizes.push_back(std::abs(filtered.at<float>(y, x)));
      }
    }
  }
  if (sizes.empty()) return kRounding;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max<double>(kRounding, *middle / (kGain * kMedianOfNormal));
}

// The bound of a crossing's standard deviation for white noise, px: the gradients of the window are its information.
double bound_px(const cv::Mat& grey, const Vector2d& pixel, int half_px, double noise_grey) {
  const cv::Rect window =
      cv::Rect(static_cast<int>(std::lround(pixel.x())) - half_px, static_cast<int>(std::lround(pixel.y())) - half_px,
               2 * half_px + 1, 2 * half_px + 1) &
      cv::Rect(1, 1, grey.cols - 2, grey.rows - 2);
  Eigen::Matrix2d information = 1e-12 * Eigen::Matrix2d::Identity();
  for (int y = window.y; y < window.br().y; ++y) {
    for (int x = window.x; x < window.br().x; ++x) {
      const Vector2d gradient(0.5 * (grey.at<unsigned char>(y, x + 1) - grey.at<unsigned char>(y, x - 1)),
                              0.5 * (grey.at<unsigned char>(y + 1, x) - grey.at<unsigned char>(y - 1, x)));
      information += gradient * gradient.transpose();
    }
  }
  return noise_grey * std::sqrt(0.5 * information.inverse().trace());
}

// The largest upright square window about a guess that no other edge enters, px from its middle to its border.
double clear_half_width(const CrossingGuess& guess) {
  const double area = std::abs(guess.step_x.x() * guess.step_y.y() - guess.step_x.y() * guess.step_y.x());
  return area / std::max(guess.step_x.lpNorm<1>(), guess.step_y.lpNorm<1>());
}

// Where the edges cross, or empty where that is too far away.
std::optional<RefinedCorner> refine(const cv::Mat& grey, const CrossingGuess& guess, double noise_grey) {
  constexpr int kLeast_px = 2, kMost_px = 12;
  constexpr double kBlur_px = 1.5;          // by which other edges reach into the window
  constexpr double kOverBound = 1.6;        // cornerSubPix weighs its window, and not by what tells most
  constexpr double kLeastSigma_px = 0.025;  // measured on renderings without noise to speak of
  constexpr double kCrowdedSigma_px = 0.3;  // where other edges reach into the smallest window
  const double clear = clear_half_width(guess);
  const int half = std::clamp(static_cast<int>(std::lround(clear - kBlur_px)), kLeast_px, kMost_px);
  std::vector<cv::Point2f> point{{static_cast<float>(guess.pixel.x()), static_cast<float>(guess.pixel.y())}};
  cv::cornerSubPix(grey, point, {half, half}, {-1, -1}, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-3});
  const Vector2d pixel(point[0].x, point[0].y);
  if (!((pixel - guess.pixel).norm() <= guess.within_px)) return std::nullopt;
  if (clear < kLeast_px + kBlur_px) return RefinedCorner{pixel, kCrowdedSigma_px};
  return RefinedCorner{pixel, std::hypot(kLeastSigma_px, kOverBound * bound_px(grey, pixel, half, noise_grey))};
}

bool has_margin(const cv::Mat& grey, const Vector2d& pixel) {
  constexpr double kMargin_px = 3;
  return pixel.x() >= kMargin_px && pixel.y() >= kMargin_px && pixel.x() <= grey.cols - 1 - kMargin_px &&
         pixel.y() <= grey.rows - 1 - kMargin_px;
}

}  // namespace

std::vector<BoardCorner> refine_crossings(const cv::Mat& grey, std::span<const CrossingGuess> guesses) {
  if (grey.type() != CV_8UC1) throw std::invalid_argument("refine_crossings: the image must be grey, of 8 bits");
  const double noise_grey = noise_of(grey);
  std::vector<BoardCorner> corners;
  for (const CrossingGuess& guess : guesses) {
    if (!has_margin(grey, guess.pixel)) continue;
    if (const auto refined = refine(grey, guess, noise_grey)) {
      corners.push_back({guess.id, refined->pixel, refined->sigma_px});
    }
  }
  return corners;
}

}  // namespace alidade
