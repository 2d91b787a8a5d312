// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_drawing.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "calib/boards/board_pattern.h"

namespace alidade {
namespace {

// How much of each pixel a stretch covers; pixel i reaches from i to i + 1. A rounding error is no coverage.
struct Coverage {
  int first = 0;
  std::vector<float> shares;
};

Coverage cover(double from, double to, int pixels) {
  constexpr double kRounding_px = 1e-6;
  Coverage coverage{std::clamp(static_cast<int>(std::floor(from + kRounding_px)), 0, pixels), {}};
  const int end = std::clamp(static_cast<int>(std::ceil(to - kRounding_px)), coverage.first, pixels);
  for (int i = coverage.first; i < end; ++i) {
    coverage.shares.push_back(static_cast<float>(std::min(to, i + 1.0) - std::max<double>(from, i)));
  }
  return coverage;
}

void blacken(cv::Mat& white, const Coverage& x, const Coverage& y) {
  for (std::size_t i = 0; i < y.shares.size(); ++i) {
    float* row = white.ptr<float>(y.first + static_cast<int>(i)) + x.first;
    for (std::size_t j = 0; j < x.shares.size(); ++j) row[j] -= 255.0f * x.shares[j] * y.shares[i];
  }
}

}  // namespace

BoardDrawing draw_board(const Board& board, double pixels_per_m, double margin_m) {
  if (!(pixels_per_m > 0)) throw std::invalid_argument("draw_board: pixels_per_m must be > 0");
  if (!(margin_m >= 0)) throw std::invalid_argument("draw_board: margin_m must be >= 0");
  const BoardPattern pattern = pattern_of(board);
  // Whole pixels of margin at the top left put the pattern's own edges between pixels.
  const double margin_px = std::round(margin_m * pixels_per_m);
  const Eigen::Vector2d start_px = Eigen::Vector2d::Constant(margin_px) - pixels_per_m * pattern.extent.min();
  const Eigen::Vector2d size_px = pixels_per_m * pattern.extent.sizes() + Eigen::Vector2d::Constant(2 * margin_px);
  cv::Mat white(static_cast<int>(std::ceil(size_px.y() - 1e-6)), static_cast<int>(std::ceil(size_px.x() - 1e-6)),
                CV_32FC1, cv::Scalar(255));
  for (const Eigen::AlignedBox2d& box : pattern.black) {
    const Eigen::Vector2d from = start_px + pixels_per_m * box.min();
    const Eigen::Vector2d to = start_px + pixels_per_m * box.max();
    blacken(white, cover(from.x(), to.x(), white.cols), cover(from.y(), to.y(), white.rows));
  }
  BoardDrawing drawing{{}, start_px - Eigen::Vector2d::Constant(0.5), pixels_per_m};
  white.convertTo(drawing.image, CV_8UC1);
  return drawing;
}

}  // namespace alidade
