// SPDX-License-Identifier: Apache-2.0
#include "calib/guide/capture_wish.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

#include "calib/cameras/view_selection.h"

namespace alidade {
namespace {

constexpr double kWishedTilt = 30 * std::numbers::pi / 180;  // focal length against loss of sharpness and of corners

using Pixels = std::vector<Eigen::Vector2d>;

std::optional<Pixels> pixels_of(const Camera& camera, const BoardShape& shape,
                                const Eigen::Isometry3d& T_camera_board) {
  Pixels pixels;
  for (const Eigen::Vector3d& corner : shape.corners_m) {
    const auto seen = project(camera, T_camera_board * corner);
    if (!seen) return std::nullopt;
    pixels.push_back(seen->pixel);
  }
  return pixels;
}

// What brings all pixels into the image with a margin, as far as that can be.
Eigen::Vector2d push_inside(const Camera& camera, const Pixels& pixels) {
  const double margin = 0.02 * camera.width;
  Eigen::Vector2d least = pixels.front(), most = least;
  for (const Eigen::Vector2d& pixel : pixels) {
    least = least.cwiseMin(pixel);
    most = most.cwiseMax(pixel);
  }
  const Eigen::Array2d end(camera.width - 1 - margin, camera.height - 1 - margin);
  return (margin - least.array()).max(0.0) - (most.array() - end).max(0.0);
}

struct Placed {
  BoardStance stance;
  Eigen::Isometry3d T_camera_board;
  Pixels pixels;
};

// The stance nearest to the one wanted that shows the whole board: moved first, then made smaller.
std::optional<Placed> place_inside(const Camera& camera, const BoardShape& shape, const BoardStance& wanted) {
  const Eigen::Vector2d middle(0.5 * (camera.width - 1), 0.5 * (camera.height - 1));
  BoardStance stance = wanted;
  for (int smaller = 0; smaller < 6; ++smaller, stance.image_share *= 0.85) {
    stance.centre_px = wanted.centre_px;
    for (int moves = 0; moves < 12; ++moves) {
      const auto T = pose_with(camera, shape, stance);
      const auto pixels = T ? pixels_of(camera, shape, *T) : std::nullopt;
      if (!pixels) {
        stance.centre_px += 0.2 * (middle - stance.centre_px);
        continue;
      }
      const Eigen::Vector2d push = push_inside(camera, *pixels);
      if (push.norm() < 1) return Placed{stance, *T, *pixels};
      stance.centre_px += push;
    }
  }
  return std::nullopt;
}

bool repeats(const Pixels& pixels, const CaptureSituation& s) {
  BoardView wished;
  for (const Eigen::Vector2d& pixel : pixels)
    wished.corners.push_back({static_cast<int>(wished.corners.size()), pixel});
  return std::any_of(s.views.begin(), s.views.end(), [&](const BoardView& view) {
    const auto motion = view_motion_px(view, wished);
    return motion && *motion < s.repeated_px;
  });
}

// Empty cells first, and of these the one of which the least is known.
std::vector<int> cells_by_need(const CaptureSituation& s, const CoverageOptions& options) {
  const ImageExtent image{s.camera.width, s.camera.height};
  const Eigen::Vector2d middle(0.5 * (image.width - 1), 0.5 * (image.height - 1));
  const auto need = [&](int cell) {
    const auto i = static_cast<std::size_t>(cell);
    const bool is_empty = s.coverage.corners[i] < options.corners_per_cell;
    const double unknown =
        s.cell_sigma_px.empty()
            ? (cell_centre_px(image, options, cell % options.columns, cell / options.columns) - middle).norm()
            : s.cell_sigma_px[i];
    return std::pair(is_empty, unknown);
  };
  std::vector<int> cells(s.coverage.corners.size());
  std::iota(cells.begin(), cells.end(), 0);
  std::stable_sort(cells.begin(), cells.end(), [&](int a, int b) { return need(a) > need(b); });
  return cells;
}

std::array<std::size_t, 4> tilts_by_need(const CaptureCoverage& coverage) {
  std::array<std::size_t, 4> tilts{0, 1, 2, 3};
  std::stable_sort(tilts.begin(), tilts.end(),
                   [&](std::size_t a, std::size_t b) { return coverage.tilted[a] < coverage.tilted[b]; });
  return tilts;
}

// Well on the right side of what counts as near and far. Two near views to a far one: they reach more cells, and more
// pixels to a corner's error.
std::array<double, 2> shares_by_need(const CaptureCoverage& coverage, const CoverageOptions& options) {
  const double near = 1.2 * options.near_share, far = 0.85 * options.far_share;
  if (coverage.near < 2 * (coverage.far + 1)) return {near, far};
  return {far, near};
}

std::array<Eigen::Vector2d, 4> outline_of(const Camera& camera, const BoardShape& shape,
                                          const Eigen::Isometry3d& T_camera_board) {
  Eigen::Vector3d least = shape.corners_m.front(), most = least;
  for (const Eigen::Vector3d& p : shape.corners_m) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  const std::array<Eigen::Vector3d, 4> ends{least, {most.x(), least.y(), 0}, most, {least.x(), most.y(), 0}};
  std::array<Eigen::Vector2d, 4> outline;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto seen = project(camera, T_camera_board * ends[i]);
    outline[i] = seen ? seen->pixel : Eigen::Vector2d(-1, -1);
  }
  return outline;
}

}  // namespace

std::optional<CaptureWish> next_wish(const CaptureSituation& s, const CoverageOptions& options) {
  const ImageExtent image{s.camera.width, s.camera.height};
  for (const int cell : cells_by_need(s, options)) {
    const int column = cell % options.columns, row = cell / options.columns;
    for (const double share : shares_by_need(s.coverage, options)) {
      for (const std::size_t tilt : tilts_by_need(s.coverage)) {
        const auto placed = place_inside(
            s.camera, s.shape, {cell_centre_px(image, options, column, row), kTilts[tilt], kWishedTilt, share});
        if (!placed || repeats(placed->pixels, s)) continue;
        return CaptureWish{column, row, placed->stance, placed->T_camera_board,
                           outline_of(s.camera, s.shape, placed->T_camera_board)};
      }
    }
  }
  return std::nullopt;
}

}  // namespace alidade
