// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "calib/guide/capture_coverage.h"

namespace alidade {

/// The view to take next.
struct CaptureWish {
  int column = 0, row = 0;                    ///< the cell of the image that the board should reach
  BoardStance stance;                         ///< its middle lies nearer to the image's where the cell is at the border
  Eigen::Isometry3d T_camera_board;           ///< the same as a pose, by the camera as it is known now
  std::array<Eigen::Vector2d, 4> outline_px;  ///< where its outermost corners then are, around the board
};

/// All that a wish follows from.
struct CaptureSituation {
  const Camera& camera;
  const BoardShape& shape;
  std::span<const BoardView> views;       ///< that there are
  const CaptureCoverage& coverage;        ///< of these
  std::span<const double> cell_sigma_px;  ///< by cell; empty where nothing is known of the lens yet
  double repeated_px = 0;                 ///< views closer than this show nothing new
};

/// The empty cell of which the least is known, with the tilt and at the distance that the fewest views have; a whole
/// board in the image, no repetition of a view. Before anything is known of the lens, cells far from the image's middle
/// come first. Empty where no board fits, or all views that could be wished for are there.
std::optional<CaptureWish> next_wish(const CaptureSituation& situation, const CoverageOptions& options);

}  // namespace alidade
