// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace alidade {

enum class BoardKind { Chessboard, Charuco, AprilGrid };

/// Two ways in which ChArUco boards are printed: OpenCV 4.6 and later put a marker or a black square into the top-left
/// corner by turns with the number of rows. ("Legacy" boards of an even number of rows start with a white square.)
enum class CharucoLayout { BlackFirst, MarkerFirst };

/// A flat calibration pattern. Its frame: x along the rows, y down the columns, z away from who looks at the print, the
/// origin at corner 0; all corners have z = 0.
struct Board {
  BoardKind kind = BoardKind::Chessboard;
  int columns = 9;           ///< chessboard: inner corners along a row; ChArUco: squares; AprilGrid: tags
  int rows = 6;              ///< the same down a column
  double square_m = 0.025;   ///< side of a square; AprilGrid: of a tag
  double marker_m = 0;       ///< ChArUco: side of a marker
  double gap_m = 0;          ///< AprilGrid: from one tag to the next
  std::string dictionary{};  ///< of the markers, OpenCV's name without "DICT_": "4X4_50", "APRILTAG_36h11"
  CharucoLayout layout = CharucoLayout::BlackFirst;
  bool operator==(const Board&) const = default;
};

/// Says what is impossible about a board ("a chessboard has at least 3x3 inner corners, got 2x6"); empty where nothing.
std::optional<std::string> find_fault(const Board& board);

/// How many corners the board has: inner corners of a chessboard or ChArUco, four of each tag of an AprilGrid.
int corner_count(const Board& board);

/// Where the corners lie in the board's frame, m, by their id: row by row; of an AprilGrid four per tag in ArUco's
/// order (clockwise from the top-left one), tags row by row.
std::vector<Eigen::Vector3d> corners_m(const Board& board);

/// "chessboard 9x6, squares of 25 mm": for people.
std::string describe(const Board& board);

}  // namespace alidade
