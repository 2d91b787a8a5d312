// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/marker_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "calib/boards/board_pattern.h"
#include "calib/boards/placed_markers.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

Vector2d centre_of(const FoundMarker& marker) {
  return 0.25 * (marker.corners[0] + marker.corners[1] + marker.corners[2] + marker.corners[3]);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// From one marker to another, in sides of the first one along its own axes.
struct Offset {
  int from, to;
  Vector2d sides;
};

std::vector<Offset> offsets_from(const FoundMarker& marker, std::span<const FoundMarker> markers) {
  constexpr double kFarthest = 4;  // sides
  const std::array<Vector2d, 4> unit{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
  std::vector<Offset> offsets;
  const auto H = homography_between(marker.corners, unit, Outliers::None);
  if (!H) return offsets;
  for (const FoundMarker& other : markers) {
    const Vector2d sides = map_by(*H, centre_of(other));
    if (other.id != marker.id && sides.norm() < kFarthest) offsets.push_back({marker.id, other.id, sides});
  }
  return offsets;
}

// Where the numbers of an AprilGrid's tags may run, by their own axes: turned, and counted upwards.
struct GridNumbering {
  bool is_upwards;
  int quarters;
};

bool explains_grid(const NeighbourPair& pair, int columns, const GridNumbering& numbering) {
  int right = pair.right, down = pair.down;
  for (int i = 0; i < numbering.quarters; ++i) std::tie(right, down) = std::pair(-down, right);
  if (numbering.is_upwards) down = -down;
  return pair.to % columns - pair.from % columns == right && pair.to / columns - pair.from / columns == down;
}

struct Explanation {
  Board board;
  std::vector<NeighbourPair> pairs;  // that it explains
};

constexpr int kMostColumns = 50;

Explanation explain_grid(std::span<const NeighbourPair> pairs) {
  Explanation best;
  for (int columns = 1; columns <= kMostColumns; ++columns) {
    for (int i = 0; i < 8; ++i) {
      Explanation candidate{{BoardKind::AprilGrid, columns, 0}, {}};
      std::ranges::copy_if(pairs, std::back_inserter(candidate.pairs), [&](const NeighbourPair& pair) {
        return explains_grid(pair, columns, {i >= 4, i % 4});
      });
      if (candidate.pairs.size() > best.pairs.size()) best = candidate;
    }
  }
  for (const NeighbourPair& pair : best.pairs) {
    best.board.rows = std::max(best.board.rows, std::max(pair.from, pair.to) / best.board.columns + 1);
  }
  return best;
}

Explanation explain_charuco(std::span<const NeighbourPair> pairs, int last_id) {
  Explanation best;
  for (int columns = 3; columns <= kMostColumns; ++columns) {
    for (const CharucoLayout layout : {CharucoLayout::BlackFirst, CharucoLayout::MarkerFirst}) {
      Explanation candidate{{BoardKind::Charuco, columns, 0}, {}};
      candidate.board.layout = layout;
      candidate.board.rows = 2 * (last_id + 1) / columns + 2;  // more than enough
      const auto at = markers(candidate.board);
      int rows = 0;
      for (const NeighbourPair& pair : pairs) {
        const BoardMarker& from = at[static_cast<std::size_t>(pair.from)];
        const BoardMarker& to = at[static_cast<std::size_t>(pair.to)];
        if (to.column - from.column != pair.right || to.row - from.row != pair.down) continue;
        candidate.pairs.push_back(pair);
        rows = std::max({rows, from.row + 1, to.row + 1});
      }
      candidate.board.rows = rows;
      if (candidate.pairs.size() > best.pairs.size()) best = candidate;
    }
  }
  return best;
}

}  // namespace

std::optional<MarkerLattice> find_lattice(std::span<const FoundMarker> found) {
  constexpr std::size_t kLeast = 4;
  constexpr double kTolerance = 0.25;  // of a step
  if (found.size() < kLeast) return std::nullopt;
  std::vector<Offset> offsets;
  std::vector<double> longer, slants;
  for (const FoundMarker& marker : found) {
    const auto around = offsets_from(marker, found);
    if (around.empty()) continue;
    offsets.insert(offsets.end(), around.begin(), around.end());
    const auto nearest = std::ranges::min_element(around, {}, [](const Offset& o) { return o.sides.norm(); });
    const Vector2d size = nearest->sides.cwiseAbs();
    longer.push_back(size.maxCoeff());
    slants.push_back(size.minCoeff() / size.maxCoeff());
  }
  if (longer.size() < kLeast) return std::nullopt;
  MarkerLattice lattice;
  lattice.kind = median(slants) > 0.5 ? BoardKind::Charuco : BoardKind::AprilGrid;
  const double step = median(longer);
  lattice.marker_share = 1 / step;
  const int distance = lattice.kind == BoardKind::Charuco ? 2 : 1;  // right and down together
  for (const Offset& offset : offsets) {
    const Vector2d steps = offset.sides / step;
    const Vector2d whole = steps.array().round();
    if ((steps - whole).norm() > kTolerance || whole.cwiseAbs().maxCoeff() > 1) continue;
    if (static_cast<int>(whole.lpNorm<1>()) != distance) continue;
    lattice.pairs.push_back({offset.from, offset.to, static_cast<int>(whole.x()), static_cast<int>(whole.y())});
  }
  if (lattice.pairs.size() < kLeast) return std::nullopt;
  return lattice;
}

std::optional<Board> explain_lattice(std::span<const MarkerLattice> lattices) {
  constexpr double kLeastShare = 0.8;
  if (lattices.empty()) return std::nullopt;
  std::vector<NeighbourPair> pairs;
  std::vector<double> shares;
  int last_id = 0;
  for (const MarkerLattice& lattice : lattices) {
    if (lattice.kind != lattices.front().kind) continue;
    pairs.insert(pairs.end(), lattice.pairs.begin(), lattice.pairs.end());
    shares.push_back(lattice.marker_share);
  }
  for (const NeighbourPair& pair : pairs) last_id = std::max({last_id, pair.from, pair.to});
  Explanation best =
      lattices.front().kind == BoardKind::Charuco ? explain_charuco(pairs, last_id) : explain_grid(pairs);
  if (static_cast<double>(best.pairs.size()) < kLeastShare * static_cast<double>(pairs.size())) return std::nullopt;
  const double share = median(shares);
  best.board.square_m = best.board.kind == BoardKind::Charuco ? 1 : share;
  if (best.board.kind == BoardKind::Charuco) best.board.marker_m = share;
  if (best.board.kind == BoardKind::AprilGrid) best.board.gap_m = 1 - share;
  if (find_fault(best.board)) return std::nullopt;
  return best.board;
}

}  // namespace alidade
