// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/boards/board.h"
#include "calib/boards/marker_finder.h"

namespace alidade {

/// Two markers next to each other, and the way from one to the other by the first one's own axes.
struct NeighbourPair {
  int from = 0, to = 0;  ///< ids
  int right = 0, down = 0;
};

/// How the markers of an image lie to each other.
struct MarkerLattice {
  BoardKind kind = BoardKind::Charuco;  ///< diagonal neighbours: ChArUco; beside each other: AprilGrid
  double marker_share = 0;  ///< side of a marker as a share of the lattice's step: of a square, or of a tag and its gap
  std::vector<NeighbourPair> pairs;
};

/// The lattice of a board's markers; empty for fewer than four markers or where they lie in none. Unknown are the
/// board's size and its scale; the lens need not be known, as each marker is looked at with its neighbours only.
std::optional<MarkerLattice> find_lattice(std::span<const FoundMarker> markers);

/// The board whose markers have these ids next to each other: kind, columns, rows (as far down as there are pairs) and
/// layout; its steps are 1 m. Empty where no board explains four fifths of the pairs.
std::optional<Board> explain_lattice(std::span<const MarkerLattice> lattices);

}  // namespace alidade
