// SPDX-License-Identifier: Apache-2.0
#include "datasets/drawn_dot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

// The part of the pixel column about x that a chord of half-length `half` about 0 covers.
double covered(double x, double half) {
  return std::max(0.0, std::min(x + 0.5, half) - std::max(x - 0.5, -half));
}

// The share of a disc of radius r about the origin in the unit pixel about (x, y), by chords.
double disc_share(double x, double y, double r) {
  constexpr int kChords = 64;
  double sum = 0.0;
  for (int i = 0; i < kChords; ++i) {
    const double v = y - 0.5 + (i + 0.5) / kChords;
    if (std::abs(v) < r) sum += covered(x, std::sqrt(r * r - v * v));
  }
  return sum / kChords;
}

}  // namespace

void draw_dot(cv::Mat& picture, const DrawnDot& dot, double blur_px) {
  if (picture.type() != CV_32FC1) throw std::invalid_argument("draw_dot: the picture must be of 32-bit floats");
  if (!(dot.size_px > 0.0)) throw std::invalid_argument("draw_dot: size_px must be > 0 px");
  const double radius = 0.5 * dot.size_px;
  const int blur_reach = static_cast<int>(std::ceil(4.0 * blur_px));
  const int reach = static_cast<int>(std::ceil(radius)) + 1 + blur_reach;
  const int left = static_cast<int>(std::lround(dot.pixel.x())) - reach;
  const int top = static_cast<int>(std::lround(dot.pixel.y())) - reach;
  cv::Mat patch(2 * reach + 1, 2 * reach + 1, CV_32FC1);
  for (int y = 0; y < patch.rows; ++y) {
    for (int x = 0; x < patch.cols; ++x) {
      patch.at<float>(y, x) =
          static_cast<float>(dot.contrast * disc_share(left + x - dot.pixel.x(), top + y - dot.pixel.y(), radius));
    }
  }
  const int kernel = 2 * blur_reach + 1;
  if (blur_px > 0.0) cv::GaussianBlur(patch, patch, {kernel, kernel}, blur_px, blur_px, cv::BORDER_CONSTANT);
  const cv::Rect area = cv::Rect({left, top}, patch.size()) & cv::Rect({}, picture.size());
  if (area.empty()) return;
  cv::Mat there = picture(area);
  there += patch(area - cv::Point(left, top));
}

}  // namespace alidade
