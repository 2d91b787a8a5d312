// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/marker_detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

#include <Eigen/LU>

#include "calib/boards/board_pattern.h"
#include "calib/boards/crossing_refinement.h"
#include "calib/boards/marker_dictionary.h"
#include "calib/boards/placed_markers.h"
#include "calib/boards/quadratic_map.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

// How far the outlines of markers may lead from a corner: in px, or as a share of the distance to the next edge.
constexpr double kWithin_px = 3.0, kWithinShare = 0.25;

// What is free of other edges about each corner, m along both axes of the board: to the ends of the edges, and to
// either side of them.
struct Clearance {
  double along_m, beside_m;
};

Clearance clearance(const Board& board, int border_cells) {
  if (board.kind == BoardKind::Charuco) return {0.4 * board.square_m, 0.5 * (board.square_m - board.marker_m)};
  const int cells = marker_cells(board.dictionary, 0).cols + 2 * (border_cells - 1);
  return {board.gap_m, board.square_m * border_cells / cells};
}

// A guess at a corner from a map of the board into the image, of which it is off by at most `within_px` or a share of
// the distance to the next edge.
struct GuessMaker {
  std::vector<Eigen::Vector3d> corners;  // of the board, m
  Clearance clear;
  double within_px, within_share;

  Vector2d on_board(int id) const { return corners[static_cast<std::size_t>(id)].head<2>(); }

  template <class Map>
  CrossingGuess at(int id, const Map& map) const {
    const Vector2d p = on_board(id);
    const Vector2d pixel = map(p);
    const Vector2d step_x = map(p + Vector2d(clear.along_m, 0)) - pixel;
    const Vector2d step_y = map(p + Vector2d(0, clear.along_m)) - pixel;
    const double band = std::min(1.0, clear.beside_m / clear.along_m);
    const double within = within_share * band * std::min(step_x.norm(), step_y.norm());
    return {id, pixel, step_x, step_y, band, std::max(within_px, within)};
  }

  CrossingGuess at(int id, const Eigen::Matrix3d& H_image_board) const {
    return at(id, [&](const Vector2d& p) { return map_by(H_image_board, p); });
  }
};

// What the lens adds to the perspective of the whole board about a corner, by the corners around it.
std::optional<QuadraticMap> bend_about(const GuessMaker& maker, int id, double reach_m,
                                       std::span<const BoardCorner> corners, const Eigen::Matrix3d& H_image_board) {
  std::vector<Vector2d> on_board, bends_px;
  for (const BoardCorner& corner : corners) {
    const Vector2d p = maker.on_board(corner.id);
    if (corner.id == id || (p - maker.on_board(id)).lpNorm<Eigen::Infinity>() > reach_m) continue;
    on_board.push_back(p);
    bends_px.push_back(corner.pixel - map_by(H_image_board, p));
  }
  return QuadraticMap::fit(on_board, bends_px, maker.on_board(id), reach_m);
}

// Of the whole board; none of the corners is off by much.
std::optional<Eigen::Matrix3d> homography_through(const GuessMaker& maker, std::span<const BoardCorner> corners) {
  std::vector<Vector2d> on_board, in_image;
  for (const BoardCorner& corner : corners) {
    on_board.push_back(maker.on_board(corner.id));
    in_image.push_back(corner.pixel);
  }
  return homography_between(on_board, in_image, Outliers::None);
}

// Outlines of markers lead to the corners within a few pixels, and at times to something else than the corner. Then
// each corner is looked for once more where those around it have it; with too few around it the first result stands.
std::vector<BoardCorner> refine_twice(const cv::Mat& grey, const Board& board, std::span<const CrossingGuess> guesses,
                                      GuessMaker maker) {
  constexpr double kReach = 2.1;  // squares, or tags with their gap
  maker.within_px = 0.7;
  maker.within_share = 0.15;
  const double reach_m = kReach * (board.square_m + board.gap_m);
  const auto first = refine_crossings(grey, guesses);
  const auto H = homography_through(maker, first);
  if (!H) return first;
  std::vector<CrossingGuess> again;
  std::vector<BoardCorner> corners;
  for (const CrossingGuess& guess : guesses) {
    if (const auto bend = bend_about(maker, guess.id, reach_m, first, *H)) {
      again.push_back(maker.at(guess.id, [&](const Vector2d& p) -> Vector2d { return map_by(*H, p) + bend->at(p); }));
      if ((again.back().pixel - guess.pixel).norm() > guess.within_px) again.pop_back();
    } else if (const auto same = std::ranges::find(first, guess.id, &BoardCorner::id); same != first.end()) {
      corners.push_back(*same);
    }
  }
  const auto second = refine_crossings(grey, again);
  corners.insert(corners.end(), second.begin(), second.end());
  std::ranges::sort(corners, {}, &BoardCorner::id);
  return corners;
}

// The markers in the four squares about an inner corner of a ChArUco board: two, or fewer.
std::vector<PlacedMarker> markers_about(std::span<const PlacedMarker> markers, int column, int row) {
  std::vector<PlacedMarker> about;
  for (const PlacedMarker& marker : markers) {
    const int right = marker.on_board.column - column, down = marker.on_board.row - row;
    if (right >= 0 && right <= 1 && down >= 0 && down <= 1) about.push_back(marker);
  }
  return about;
}

std::vector<BoardCorner> charuco_corners(const cv::Mat& grey, const Board& board) {
  const auto on_board = markers(board);
  const auto found = find_markers(grey, {board.dictionary, 1, false, static_cast<int>(on_board.size())});
  const auto placed = place_consistently(found, on_board);
  const GuessMaker maker{corners_m(board), clearance(board, 1), kWithin_px, kWithinShare};
  std::vector<CrossingGuess> guesses;
  for (int id = 0; id < corner_count(board); ++id) {
    const auto about = markers_about(placed, id % (board.columns - 1), id / (board.columns - 1));
    if (about.empty()) continue;
    if (const auto H = homography_of(about)) guesses.push_back(maker.at(id, *H));
  }
  return refine_twice(grey, board, guesses, maker);
}

// How the tags of an AprilGrid count: ours, or upwards; and by how many quarters each tag is turned.
struct Numbering {
  bool is_upwards = false;
  std::size_t quarters = 0;
};

std::vector<BoardMarker> numbered(const Board& board, const Numbering& numbering) {
  std::vector<BoardMarker> tags = markers(board);
  std::vector<BoardMarker> result = tags;
  for (BoardMarker& tag : result) {
    const int row = numbering.is_upwards ? board.rows - 1 - tag.row : tag.row;
    const auto at = tags[static_cast<std::size_t>(row * board.columns + tag.column)];
    tag.row = row;
    for (std::size_t c = 0; c < 4; ++c) tag.corners[c] = at.corners[(c + numbering.quarters) % 4];
  }
  return result;
}

bool shows_numbering(const Board& board, std::span<const PlacedMarker> placed) {
  std::set<int> columns, rows;
  for (const PlacedMarker& tag : placed) {
    columns.insert(tag.on_board.column);
    rows.insert(tag.on_board.row);
  }
  return static_cast<int>(columns.size()) >= std::min(2, board.columns) &&
         static_cast<int>(rows.size()) >= std::min(2, board.rows);
}

// The tags by the numbering that most of them agree with; of equals the first, which is ours.
std::vector<PlacedMarker> place_tags(const Board& board, std::span<const FoundMarker> found) {
  std::vector<PlacedMarker> best;
  for (const bool is_upwards : {false, true}) {
    for (std::size_t quarters = 0; quarters < 4; ++quarters) {
      const auto placed = place_consistently(found, numbered(board, {is_upwards, quarters}));
      if (placed.size() > best.size()) best = placed;
    }
  }
  if (board.columns * board.rows == 1 && found.size() == 1 && found[0].id == 0) {
    best = {{markers(board)[0], found[0].corners}};
  }
  return shows_numbering(board, best) ? best : std::vector<PlacedMarker>{};
}

// A tag and those next to it: what touches by its corners is outlined worse than what stands alone.
std::vector<PlacedMarker> tags_about(std::span<const PlacedMarker> tags, const PlacedMarker& middle) {
  std::vector<PlacedMarker> about;
  for (const PlacedMarker& tag : tags) {
    const int right = tag.on_board.column - middle.on_board.column, down = tag.on_board.row - middle.on_board.row;
    if (std::abs(right) <= 1 && std::abs(down) <= 1) about.push_back(tag);
  }
  return about;
}

std::vector<BoardCorner> grid_corners(const cv::Mat& grey, const Board& board) {
  for (const int border_cells : {1, 2}) {
    const auto found = find_markers(grey, {board.dictionary, border_cells, true, board.columns * board.rows});
    const auto placed = place_tags(board, found);
    if (placed.empty()) continue;
    const GuessMaker maker{corners_m(board), clearance(board, border_cells), kWithin_px, kWithinShare};
    std::vector<CrossingGuess> guesses;
    for (const PlacedMarker& tag : placed) {
      const auto H = homography_of(tags_about(placed, tag));
      const int first = 4 * (tag.on_board.row * board.columns + tag.on_board.column);
      for (int id = first; H && id < first + 4; ++id) guesses.push_back(maker.at(id, *H));
    }
    return refine_twice(grey, board, guesses, maker);
  }
  return {};
}

// Whether the corners tell a pose: four or more, not all in one row or column.
bool span_a_plane(const Board& board, std::span<const BoardCorner> corners) {
  const auto at = corners_m(board);
  std::set<double> x, y;
  for (const BoardCorner& corner : corners) {
    x.insert(at[static_cast<std::size_t>(corner.id)].x());
    y.insert(at[static_cast<std::size_t>(corner.id)].y());
  }
  return corners.size() >= 4 && x.size() >= 2 && y.size() >= 2;
}

}  // namespace

std::optional<BoardView> detect_markers_board(const cv::Mat& grey, const Board& board) {
  if (board.kind == BoardKind::Chessboard) throw std::invalid_argument("detect_markers_board: a chessboard has none");
  if (const auto fault = find_fault(board)) throw std::invalid_argument(*fault);
  BoardView view;
  view.corners = board.kind == BoardKind::Charuco ? charuco_corners(grey, board) : grid_corners(grey, board);
  if (!span_a_plane(board, view.corners)) return std::nullopt;
  return view;
}

std::optional<CharucoLayout> find_charuco_layout(const cv::Mat& grey, const Board& board) {
  if (board.kind != BoardKind::Charuco) throw std::invalid_argument("find_charuco_layout: not a ChArUco board");
  const auto found = find_markers(grey, {board.dictionary, 1, false, marker_count(board)});
  std::array<std::size_t, 2> agreeing{};
  for (const CharucoLayout layout : {CharucoLayout::BlackFirst, CharucoLayout::MarkerFirst}) {
    Board candidate = board;
    candidate.layout = layout;
    agreeing[static_cast<std::size_t>(layout)] = place_consistently(found, markers(candidate)).size();
  }
  if (agreeing[0] == agreeing[1]) return std::nullopt;
  return agreeing[0] > agreeing[1] ? CharucoLayout::BlackFirst : CharucoLayout::MarkerFirst;
}

}  // namespace alidade
