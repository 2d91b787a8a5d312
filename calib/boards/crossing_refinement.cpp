// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/crossing_refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "calib/boards/corner_refinement.h"
#include "calib/boards/edge_crossing.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

constexpr double kBlur_px = 1.5;  // by which other edges reach into the window

struct RefinedCorner {
  Vector2d pixel;
  double sigma_px;
};

constexpr double kCrowdedSigma_px = 0.3;  // of corners whose edges could not be fitted: too near to others, or hidden

// The largest upright square window about a guess that no other edge enters, px from its middle to its border.
double clear_half_width(const CrossingGuess& guess) {
  const double area = std::abs(guess.step_x.x() * guess.step_y.y() - guess.step_x.y() * guess.step_y.x());
  return guess.band * area / std::max(guess.step_x.lpNorm<1>(), guess.step_y.lpNorm<1>());
}

int gradient_half_width(const CrossingGuess& guess) {
  constexpr int kLeast_px = 2, kMost_px = 12;
  return std::clamp(static_cast<int>(std::lround(clear_half_width(guess) - kBlur_px)), kLeast_px, kMost_px);
}

std::optional<RefinedCorner> fit(const cv::Mat& grey, const CrossingGuess& guess) {
  const CornerRefinementOptions usual;
  const double step_px = std::min(guess.step_x.norm(), guess.step_y.norm());
  const double longest_px = std::max(guess.step_x.norm(), guess.step_y.norm());
  const double band = guess.band - kBlur_px / step_px;
  if (!(band * step_px > 0.5)) return std::nullopt;
  const auto crossing =
      fit_edge_crossing(grey, {.pixel = guess.pixel,
                               .step_x = guess.step_x,
                               .step_y = guess.step_y,
                               .half_width = std::min(1 - kBlur_px / step_px, usual.most_half_width_px / longest_px),
                               .band = band});
  if (!crossing) return std::nullopt;
  const double sigma = std::sqrt(0.5 * crossing->covariance_px2.trace());
  if (!(sigma < kCrowdedSigma_px)) return std::nullopt;
  return RefinedCorner{crossing->pixel, std::max(sigma, usual.least_sigma_px)};
}

// Where the edges cross, or empty where that is too far away.
std::optional<RefinedCorner> refine(const cv::Mat& grey, const CrossingGuess& guess) {
  auto refined = fit(grey, guess);
  if (!refined)
    refined = RefinedCorner{crossing_by_gradients(grey, guess.pixel, gradient_half_width(guess)), kCrowdedSigma_px};
  if (!((refined->pixel - guess.pixel).norm() <= guess.within_px)) return std::nullopt;
  return refined;
}

bool has_margin(const cv::Mat& grey, const Vector2d& pixel) {
  constexpr double kMargin_px = 3;
  return pixel.x() >= kMargin_px && pixel.y() >= kMargin_px && pixel.x() <= grey.cols - 1 - kMargin_px &&
         pixel.y() <= grey.rows - 1 - kMargin_px;
}

}  // namespace

std::vector<BoardCorner> refine_crossings(const cv::Mat& grey, std::span<const CrossingGuess> guesses) {
  if (grey.type() != CV_8UC1) throw std::invalid_argument("refine_crossings: the image must be grey, of 8 bits");
  std::vector<BoardCorner> corners;
  for (const CrossingGuess& guess : guesses) {
    if (!has_margin(grey, guess.pixel)) continue;
    if (const auto refined = refine(grey, guess)) {
      corners.push_back({guess.id, refined->pixel, refined->sigma_px});
    }
  }
  return corners;
}

}  // namespace alidade
