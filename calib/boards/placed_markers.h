// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "calib/boards/board_pattern.h"
#include "calib/boards/marker_finder.h"

namespace alidade {

/// A marker seen in an image and where it lies on the board.
struct PlacedMarker {
  BoardMarker on_board;                   ///< m
  std::array<Eigen::Vector2d, 4> pixels;  ///< px, in the order of on_board.corners
};

/// Whether some points are not what they are taken for.
enum class Outliers { None, Some };

/// From the plane of the board (m) to the image (px): by least squares, or least median of squares among outliers.
/// Empty for fewer than four points, and where they lie in one line.
std::optional<Eigen::Matrix3d> homography_between(std::span<const Eigen::Vector2d> on_board,
                                                  std::span<const Eigen::Vector2d> in_image, Outliers outliers);

/// The same through the corners of markers.
std::optional<Eigen::Matrix3d> homography_of(std::span<const PlacedMarker> markers);

/// A point of the board's plane (m) in the image (px).
Eigen::Vector2d map_by(const Eigen::Matrix3d& H_image_board, const Eigen::Vector2d& p_board);

/// The found markers that the board has (`on_board`, by id), without those that contradict their neighbours: each
/// marker by itself says where the next ones lie, within half the distance of markers. Markers without a neighbour are
/// left out. Ids read wrongly and boards taken for others end here.
std::vector<PlacedMarker> place_consistently(std::span<const FoundMarker> found, std::span<const BoardMarker> on_board);

}  // namespace alidade
