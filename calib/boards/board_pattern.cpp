// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_pattern.h"

#include <stdexcept>

#include "calib/boards/marker_dictionary.h"

namespace alidade {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

// Whether the square holds a marker; the others of a ChArUco board are black.
bool holds_marker(const Board& board, int column, int row) {
  return (column + row) % 2 == (board.layout == CharucoLayout::BlackFirst ? 1 : 0);
}

// The top left of a ChArUco square or of a tag.
Vector2d top_left(const Board& board, int column, int row) {
  if (board.kind == BoardKind::AprilGrid) return (board.square_m + board.gap_m) * Vector2d(column, row);
  return board.square_m * Vector2d(column - 1, row - 1);
}

AlignedBox2d square_at(const Vector2d& min, double side_m) {
  return {min, min + Vector2d::Constant(side_m)};
}

BoardMarker place_marker(const Board& board, int id, int column, int row) {
  const bool is_tag = board.kind == BoardKind::AprilGrid;
  const double inset = is_tag ? 0 : 0.5 * (board.square_m - board.marker_m);
  const AlignedBox2d box =
      square_at(top_left(board, column, row) + Vector2d::Constant(inset), is_tag ? board.square_m : board.marker_m);
  return {id, column, row, {box.min(), {box.max().x(), box.min().y()}, box.max(), {box.min().x(), box.max().y()}}};
}

std::vector<AlignedBox2d> black_cells(const Board& board, const BoardMarker& marker) {
  const cv::Mat cells = marker_cells(board.dictionary, marker.id);
  const double side_m = (marker.corners[1] - marker.corners[0]).x() / cells.cols;
  std::vector<AlignedBox2d> black;
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x) {
      if (cells.at<unsigned char>(y, x) != 0) continue;
      black.push_back(square_at(marker.corners[0] + side_m * Vector2d(x, y), side_m));
    }
  }
  return black;
}

BoardPattern chessboard_pattern(const Board& board) {
  BoardPattern pattern;
  pattern.extent = {Vector2d::Constant(-board.square_m), board.square_m * Vector2d(board.columns, board.rows)};
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = row % 2; column <= board.columns; column += 2) {
      pattern.black.push_back(square_at(board.square_m * Vector2d(column - 1, row - 1), board.square_m));
    }
  }
  return pattern;
}

BoardPattern charuco_pattern(const Board& board) {
  BoardPattern pattern;
  pattern.extent = {Vector2d::Constant(-board.square_m), board.square_m * Vector2d(board.columns - 1, board.rows - 1)};
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      if (holds_marker(board, column, row)) continue;
      pattern.black.push_back(square_at(top_left(board, column, row), board.square_m));
    }
  }
  return pattern;
}

BoardPattern grid_pattern(const Board& board) {
  BoardPattern pattern;
  const double step_m = board.square_m + board.gap_m;
  pattern.extent = {Vector2d::Constant(-board.gap_m), step_m * Vector2d(board.columns, board.rows)};
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = 0; column <= board.columns; ++column) {
      pattern.black.push_back(square_at(step_m * Vector2d(column, row) - Vector2d::Constant(board.gap_m), board.gap_m));
    }
  }
  return pattern;
}

}  // namespace

std::vector<BoardMarker> markers(const Board& board) {
  std::vector<BoardMarker> placed;
  if (board.kind == BoardKind::Chessboard) return placed;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      if (board.kind == BoardKind::Charuco && !holds_marker(board, column, row)) continue;
      placed.push_back(place_marker(board, static_cast<int>(placed.size()), column, row));
    }
  }
  return placed;
}

int marker_count(const Board& board) {
  if (board.kind == BoardKind::Chessboard) return 0;
  const int squares = board.columns * board.rows;
  if (board.kind == BoardKind::AprilGrid) return squares;
  return board.layout == CharucoLayout::BlackFirst ? squares / 2 : squares - squares / 2;
}

BoardPattern pattern_of(const Board& board) {
  if (const auto fault = find_fault(board)) throw std::invalid_argument(*fault);
  if (board.kind == BoardKind::Chessboard) return chessboard_pattern(board);
  BoardPattern pattern = board.kind == BoardKind::Charuco ? charuco_pattern(board) : grid_pattern(board);
  for (const BoardMarker& marker : markers(board)) {
    const auto cells = black_cells(board, marker);
    pattern.black.insert(pattern.black.end(), cells.begin(), cells.end());
  }
  return pattern;
}

}  // namespace alidade
