// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace alidade {
namespace {

std::vector<Eigen::Vector3d> lattice(int columns, int rows, double step_m) {
  std::vector<Eigen::Vector3d> corners;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) corners.emplace_back(column * step_m, row * step_m, 0.0);
  }
  return corners;
}

std::vector<Eigen::Vector3d> tag_corners(const Board& board) {
  constexpr std::array<std::array<int, 2>, 4> kClockwise{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector3d& tag : lattice(board.columns, board.rows, board.square_m + board.gap_m)) {
    for (const auto& [x, y] : kClockwise) corners.push_back(tag + board.square_m * Eigen::Vector3d(x, y, 0));
  }
  return corners;
}

}  // namespace

std::optional<std::string> find_fault(const Board& b) {
  const bool is_grid = b.kind == BoardKind::AprilGrid;
  const int least = is_grid ? 1 : 3;
  if (b.columns < least || b.rows < least) {
    return fmt::format("a board has at least {}x{} {}, got {}x{}", least, least,
                       is_grid                        ? "tags"
                       : b.kind == BoardKind::Charuco ? "squares"
                                                      : "inner corners",
                       b.columns, b.rows);
  }
  if (b.columns > 200 || b.rows > 200) return fmt::format("a board of {}x{} is too large", b.columns, b.rows);
  if (!(b.square_m > 0) || !std::isfinite(b.square_m)) {
    return fmt::format("the side of a square must be > 0 m, got {}", b.square_m);
  }
  if (b.kind == BoardKind::Charuco && !(b.marker_m > 0 && b.marker_m < b.square_m)) {
    return fmt::format("the side of a marker must lie between 0 and that of a square, {} m, got {}", b.square_m,
                       b.marker_m);
  }
  if (is_grid && !(b.gap_m > 0)) return fmt::format("the distance of two tags must be > 0 m, got {}", b.gap_m);
  return std::nullopt;
}

int corner_count(const Board& board) {
  if (board.kind == BoardKind::AprilGrid) return 4 * board.columns * board.rows;
  if (board.kind == BoardKind::Charuco) return (board.columns - 1) * (board.rows - 1);
  return board.columns * board.rows;
}

std::vector<Eigen::Vector3d> corners_m(const Board& board) {
  if (board.kind == BoardKind::AprilGrid) return tag_corners(board);
  if (board.kind == BoardKind::Charuco) return lattice(board.columns - 1, board.rows - 1, board.square_m);
  return lattice(board.columns, board.rows, board.square_m);
}

std::string describe(const Board& b) {
  if (b.kind == BoardKind::AprilGrid) {
    return fmt::format("AprilGrid of {}x{} tags {}, {:.4g} mm each, {:.4g} mm apart", b.columns, b.rows, b.dictionary,
                       1e3 * b.square_m, 1e3 * b.gap_m);
  }
  if (b.kind == BoardKind::Charuco) {
    return fmt::format("ChArUco of {}x{} squares of {:.4g} mm, markers {} of {:.4g} mm", b.columns, b.rows,
                       1e3 * b.square_m, b.dictionary, 1e3 * b.marker_m);
  }
  return fmt::format("chessboard of {}x{} inner corners, squares of {:.4g} mm", b.columns, b.rows, 1e3 * b.square_m);
}

}  // namespace alidade
