// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/corner_refinement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "calib/boards/edge_crossing.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

constexpr double kBlursInWindow = 6;  // about a crossing, to either side: beyond four there is nothing to see

class Lattice {
 public:
  Lattice(std::span<const BoardCorner> corners, int columns) : columns_(columns) {
    for (const BoardCorner& corner : corners) pixels_[corner.id] = corner.pixel;
  }

  // The corner `right` columns and `down` rows from corner `id`.
  const Vector2d* at(int id, int right, int down) const {
    const int column = id % columns_ + right;
    if (column < 0 || column >= columns_) return nullptr;
    const auto found = pixels_.find(id + right + down * columns_);
    return found == pixels_.end() ? nullptr : &found->second;
  }

 private:
  int columns_;
  std::map<int, Vector2d> pixels_;
};

// From a corner to the next one, px, by the neighbours on both sides where they are there.
std::optional<Vector2d> step_along(const Lattice& lattice, int id, int right, int down) {
  const Vector2d *next = lattice.at(id, right, down), *last = lattice.at(id, -right, -down);
  if (!next && !last) return std::nullopt;
  const Vector2d* here = lattice.at(id, 0, 0);
  const Vector2d& from = last ? *last : *here;
  const Vector2d& to = next ? *next : *here;
  return (to - from) / (next && last ? 2 : 1);
}

// How the lattice's line through a corner bends, px per step squared: the second difference of it and its neighbours,
// at the rim of its next ones; none where there are not three in a line.
Vector2d bend_along(const Lattice& lattice, int id, int right, int down) {
  for (const int middle : {0, 1, -1}) {
    const Vector2d* last = lattice.at(id, (middle - 1) * right, (middle - 1) * down);
    const Vector2d* here = lattice.at(id, middle * right, middle * down);
    const Vector2d* next = lattice.at(id, (middle + 1) * right, (middle + 1) * down);
    if (last && here && next) return *last - 2 * *here + *next;
  }
  return Vector2d::Zero();
}

// On large squares every few pixels do to see where the crossing is and how blurred; then all pixels about it.
std::optional<EdgeCrossing> fit_coarse_to_fine(const cv::Mat& grey, CrossingStart start, double most_half_width_px) {
  const double longest = std::max(start.step_x.norm(), start.step_y.norm());
  start.stride = std::max(1, static_cast<int>(start.half_width * longest / most_half_width_px));
  const auto coarse = fit_edge_crossing(grey, start);
  if (!coarse || start.stride == 1) return coarse;
  start.stride = 1;
  start.pixel = coarse->pixel;
  start.blur_px = std::ranges::max(coarse->blur_px);
  start.half_width = std::min(start.half_width, std::max(most_half_width_px, kBlursInWindow * start.blur_px) / longest);
  return fit_edge_crossing(grey, start);
}

BoardCorner refined(const cv::Mat& grey, int id, const CrossingStart& start, const CornerRefinementOptions& options) {
  if (const auto crossing = fit_coarse_to_fine(grey, start, options.most_half_width_px)) {
    const double sigma = std::sqrt(0.5 * crossing->covariance_px2.trace());
    if (sigma < options.unfitted_sigma_px) {
      return {id, crossing->pixel, std::max(sigma, options.least_sigma_px)};
    }
  }
  const double spacing = std::min(start.step_x.norm(), start.step_y.norm());
  const int half_px = std::max(2, static_cast<int>(std::lround(start.half_width * spacing)));
  return {id, crossing_by_gradients(grey, start.pixel, half_px), options.unfitted_sigma_px};
}

enum class Edges { Straight, Bent };

std::vector<BoardCorner> refine_once(const cv::Mat& grey, std::span<const BoardCorner> corners, int columns,
                                     Edges edges, const CornerRefinementOptions& options) {
  const Lattice lattice(corners, columns);
  std::vector<BoardCorner> result;
  for (const BoardCorner& corner : corners) {
    const auto step_x = step_along(lattice, corner.id, 1, 0), step_y = step_along(lattice, corner.id, 0, 1);
    if (!step_x || !step_y) continue;
    CrossingStart start{.pixel = corner.pixel, .step_x = *step_x, .step_y = *step_y};
    start.half_width = options.half_width;
    if (edges == Edges::Bent) {
      start.bend_x = bend_along(lattice, corner.id, 1, 0);
      start.bend_y = bend_along(lattice, corner.id, 0, 1);
    }
    result.push_back(refined(grey, corner.id, start, options));
  }
  return result;
}

}  // namespace

void validate(const CornerRefinementOptions& o) {
  if (!(o.half_width > 0 && o.half_width < 1)) {
    throw std::invalid_argument(fmt::format("half_width must lie between 0 and 1, got {}", o.half_width));
  }
  if (!(o.most_half_width_px >= 4)) {
    throw std::invalid_argument(fmt::format("most_half_width_px must be >= 4, got {}", o.most_half_width_px));
  }
  if (!(o.least_sigma_px > 0)) {
    throw std::invalid_argument(fmt::format("least_sigma_px must be > 0, got {}", o.least_sigma_px));
  }
  if (!(o.unfitted_sigma_px >= o.least_sigma_px)) {
    throw std::invalid_argument(
        fmt::format("unfitted_sigma_px must be >= least_sigma_px, got {}", o.unfitted_sigma_px));
  }
}

std::vector<BoardCorner> refine_corners(const cv::Mat& grey, std::span<const BoardCorner> corners, int columns,
                                        const CornerRefinementOptions& options) {
  validate(options);
  if (columns < 1) throw std::invalid_argument(fmt::format("refine_corners: columns must be >= 1, got {}", columns));
  for (const BoardCorner& corner : corners) {
    if (corner.id < 0 || !corner.pixel.allFinite()) {
      throw std::invalid_argument("refine_corners: each corner needs an id >= 0 and a finite pixel");
    }
  }
  const std::vector<BoardCorner> straight = refine_once(grey, corners, columns, Edges::Straight, options);
  return refine_once(grey, straight, columns, Edges::Bent, options);
}

}  // namespace alidade
