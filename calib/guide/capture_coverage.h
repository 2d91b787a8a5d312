// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "calib/boards/board_view.h"
#include "calib/cameras/camera_start.h"
#include "calib/guide/board_stance.h"

namespace alidade {

/// What views of a board have to show of a camera.
struct CoverageOptions {
  int columns = 5, rows = 4;    ///< cells of the image; a board at arm's length covers some four of these
  int corners_per_cell = 3;     ///< a cell with fewer of all views together is empty: three span a patch of the lens
  double least_tilt_deg = 15;   ///< less tells little of the focal length
  double near_share = 0.5;      ///< of the image from which on a board is near (BoardStance::image_share)
  double far_share = 0.35;      ///< and below which it is far: lens and board are told apart by the change of scale
  double position_share = 0.8;  ///< of the cells that is enough: the outermost may be out of a whole board's reach
};

/// Throws std::invalid_argument naming the field, its value and the bound.
void validate(const CoverageOptions& options);

/// How much is shown, each 0 to 1: of the cells, of the four tilts, of near and far.
struct CoverageShares {
  double positions = 0, tilts = 0, distances = 0;
};

/// What views show: corners in each cell, row by row, and the views by tilt (in the order of kTilts) and distance.
struct CaptureCoverage {
  std::vector<int> corners;
  std::array<int, 4> tilted{};
  int near = 0, far = 0;
};

/// A view's stance is empty where its board has no pose. Throws std::invalid_argument for another number of stances.
CaptureCoverage coverage_of(const ImageExtent& image, std::span<const BoardView> views,
                            std::span<const std::optional<BoardStance>> stances, const CoverageOptions& options);

CoverageShares shares_of(const CaptureCoverage& coverage, const CoverageOptions& options);

/// Whether nothing is missing.
bool is_complete(const CoverageShares& shares, const CoverageOptions& options);

/// The middle of a cell, px.
Eigen::Vector2d cell_centre_px(const ImageExtent& image, const CoverageOptions& options, int column, int row);

}  // namespace alidade
