// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "calib/boards/saddle_points.h"

namespace alidade {

/// A node of a lattice in an image: steps to the right and down are the lattice's own, which may be turned any way in
/// the image; from right to down one turns clockwise there.
struct LatticeNode {
  int right = 0, down = 0;
  Eigen::Vector2d pixel;
};

using Lattice = std::vector<LatticeNode>;

/// The lattices in which saddle points lie, each point in one of them at most. Neighbours lie along each other's edges
/// and their bright sides alternate. Each step is foretold from the nearest ones, so that neither perspective nor lens
/// need a model. Nodes may be missing. In a scene without a board, chance makes lattices of few nodes. Grown from the
/// first points on, which should be the strongest.
std::vector<Lattice> grow_lattices(std::span<const SaddlePoint> points);

/// Nodes of a lattice that make a whole rectangle.
struct NodeRectangle {
  int columns = 0, rows = 0;
  std::vector<Eigen::Vector2d> pixels;  ///< row by row, clockwise from right to down
};

/// The rectangle that is left where the line at the border that lacks most nodes is taken away until none lacks any;
/// empty where less than 3x3 is left, or where such a line has more nodes than chance would add to a board's: two
/// fifths.
std::optional<NodeRectangle> whole_rectangle(const Lattice& lattice);

}  // namespace alidade
