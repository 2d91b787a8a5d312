// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "calib/boards/board.h"

namespace alidade {

/// A marker of a ChArUco board or a tag of an AprilGrid.
struct BoardMarker {
  int id = 0;
  int column = 0, row = 0;                 ///< of its square, or of the tag among tags
  std::array<Eigen::Vector2d, 4> corners;  ///< m, in the board's frame, clockwise from the marker's own top left
};

/// The markers of a board by id, which run row by row from the top left; none on a chessboard.
std::vector<BoardMarker> markers(const Board& board);

/// How many markers the board has.
int marker_count(const Board& board);

/// What is printed: the black areas, which do not overlap, and the area of the whole pattern; m, in the board's frame.
struct BoardPattern {
  std::vector<Eigen::AlignedBox2d> black;
  Eigen::AlignedBox2d extent;
};

/// The pattern of a board. A chessboard and a BlackFirst ChArUco start with a black square at the top left. An
/// AprilGrid has black squares of gap_m where the gaps cross, as Kalibr prints it: they make each corner of a tag a
/// saddle point, which blur does not move. Throws std::invalid_argument for a board with a fault, an unknown dictionary
/// or more markers than its dictionary has.
BoardPattern pattern_of(const Board& board);

}  // namespace alidade
