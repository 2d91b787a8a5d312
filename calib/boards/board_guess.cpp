// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "calib/boards/board_pattern.h"
#include "calib/boards/chessboard_finder.h"
#include "calib/boards/marker_detection.h"
#include "calib/boards/marker_dictionary.h"
#include "calib/boards/marker_lattice.h"

namespace alidade {
namespace {

constexpr double kAssumedSide_m = 0.025;

// Markers of one kind; the smaller dictionaries of a family are the first markers of the largest one.
struct Family {
  std::string_view largest;
  std::string_view prefix;  // of the smaller ones; empty where there are none
  int border_cells;
};
constexpr std::array<Family, 10> kFamilies{{{"4X4_1000", "4X4_", 1},
                                            {"5X5_1000", "5X5_", 1},
                                            {"6X6_1000", "6X6_", 1},
                                            {"7X7_1000", "7X7_", 1},
                                            {"APRILTAG_36h11", "", 1},
                                            {"APRILTAG_36h11", "", 2},
                                            {"ARUCO_ORIGINAL", "", 1},
                                            {"APRILTAG_25h9", "", 1},
                                            {"APRILTAG_16h5", "", 1},
                                            {"APRILTAG_36h10", "", 1}}};

std::string smallest_dictionary(const Family& family, int count) {
  if (!family.prefix.empty()) {
    for (const std::string_view name : marker_dictionary_names()) {  // of a family in order of size
      if (name.starts_with(family.prefix) && marker_dictionary_size(name) >= count) return std::string(name);
    }
  }
  return std::string(family.largest);
}

double to_hundredths(double share) {
  return std::round(100 * share) / 100;
}

// With steps of 1 m as explain_lattice has them; scaled to the assumed size.
Board scaled(Board board) {
  if (board.kind == BoardKind::Charuco) {
    board.marker_m = kAssumedSide_m * to_hundredths(board.marker_m);
  } else {
    board.gap_m = kAssumedSide_m * to_hundredths(board.gap_m / board.square_m);
  }
  board.square_m = kAssumedSide_m;
  return board;
}

// Of the first images with markers of this family: a few are enough to look for the right family in.
std::vector<MarkerLattice> find_lattices(std::span<const cv::Mat> greys, const Family& family) {
  std::vector<MarkerLattice> lattices;
  for (const cv::Mat& grey : greys) {
    for (const bool are_touching : {false, true}) {
      const auto found = find_markers(grey, {std::string(family.largest), family.border_cells, are_touching, 0});
      const auto lattice = find_lattice(found);
      if (!lattice) continue;
      lattices.push_back(*lattice);
      break;
    }
  }
  return lattices;
}

// The view with the most corners of an AprilGrid whose gap is supposed from outlines of tags. These are too thin, as
// what touches is parted by a high threshold: the true gap is smaller.
std::optional<BoardView> view_by_some_gap(const cv::Mat& grey, Board board) {
  const double supposed_m = board.gap_m;
  std::optional<BoardView> best;
  for (const double share : {1.0, 0.9, 0.8, 0.7}) {
    board.gap_m = share * supposed_m;
    auto view = detect_markers_board(grey, board);
    if (view && (!best || view->corners.size() > best->corners.size())) best = std::move(view);
  }
  return best;
}

// The gap of an AprilGrid by its refined corners, as a share of a tag.
double measured_gap(const cv::Mat& grey, const Board& board) {
  const double supposed = board.gap_m / board.square_m;
  const auto view = view_by_some_gap(grey, board);
  if (!view) return supposed;
  std::map<int, Eigen::Vector2d> pixels;
  for (const BoardCorner& corner : view->corners) pixels[corner.id] = corner.pixel;
  std::vector<double> shares;
  for (const auto& [id, pixel] : pixels) {
    // The upper corners of a tag and of the next one to the right, if there is one.
    const bool is_start = id % 4 == 0 && id / 4 % board.columns + 1 < board.columns;
    if (!is_start || !pixels.contains(id + 1) || !pixels.contains(id + 4) || !pixels.contains(id + 5)) continue;
    const double tags = (pixels[id + 1] - pixel).norm() + (pixels[id + 5] - pixels[id + 4]).norm();
    shares.push_back(2 * (pixels[id + 4] - pixels[id + 1]).norm() / tags);
  }
  if (shares.empty()) return supposed;
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  return *middle;
}

std::optional<Board> guess_markers_board(std::span<const cv::Mat> greys) {
  constexpr std::size_t kFirst = 2;  // images in which every family is looked for
  const std::size_t first = std::min(kFirst, greys.size());
  for (const auto& images : {greys.first(first), greys.subspan(first)}) {
    for (const Family& family : kFamilies) {
      if (images.empty() || !explain_lattice(find_lattices(images, family))) continue;
      auto board = explain_lattice(find_lattices(greys, family));
      if (!board) continue;
      const int count = marker_count(*board);
      board->dictionary = smallest_dictionary(family, count);
      if (marker_dictionary_size(board->dictionary) < count) continue;
      if (board->kind == BoardKind::AprilGrid) board->gap_m = board->square_m * measured_gap(greys.front(), *board);
      return scaled(*board);
    }
  }
  return std::nullopt;
}

std::optional<Board> guess_chessboard_of(std::span<const cv::Mat> greys) {
  std::vector<ChessboardGrid> grids;
  for (const cv::Mat& grey : greys) {
    if (auto grid = guess_chessboard(grey)) grids.push_back(std::move(*grid));
  }
  const auto size = most_common_size(grids);
  if (!size) return std::nullopt;
  return Board{BoardKind::Chessboard, size->columns, size->rows, kAssumedSide_m};
}

}  // namespace

std::optional<GuessedBoard> guess_board(std::span<const cv::Mat> greys) {
  for (const cv::Mat& grey : greys) {
    if (grey.type() != CV_8UC1) throw std::invalid_argument("guess_board: images must be grey, of 8 bits");
  }
  auto board = guess_markers_board(greys);
  if (!board) board = guess_chessboard_of(greys);
  if (!board) return std::nullopt;
  return GuessedBoard{*board, true};
}

}  // namespace alidade
