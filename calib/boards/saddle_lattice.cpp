// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/saddle_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace alidade {
namespace {

using Eigen::Vector2d;

struct Node {
  int right, down;
  auto operator<=>(const Node&) const = default;
  Node operator+(const Node& step) const { return {right + step.right, down + step.down}; }
  Node operator-(const Node& step) const { return {right - step.right, down - step.down}; }
};

constexpr std::array<Node, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

// At the next corner the same edges go on with bright and dark exchanged.
bool are_exchanged(const std::array<double, 2>& one_rad, const std::array<double, 2>& other_rad) {
  constexpr double kMostTurn_rad = 0.5;  // rings on squares of a few pixels are that coarse
  const auto turn_rad = [&](int i, int j) { return angle_between_lines(one_rad[i], other_rad[j]); };
  const double first_rad = turn_rad(0, 1), second_rad = turn_rad(1, 0);
  const bool is_nearer_exchanged = first_rad + second_rad < turn_rad(0, 0) + turn_rad(1, 1);
  return is_nearer_exchanged && std::max(first_rad, second_rad) < kMostTurn_rad;
}

bool may_be_neighbours(const SaddlePoint& one, const SaddlePoint& other) {
  constexpr double kLeastRatio = 0.25;  // far weaker are noise and the steps of edges
  if (other.strength < kLeastRatio * one.strength) return false;
  return are_exchanged(one.edges_rad, other.edges_rad);
}

// Which points lie in which cell of the image.
class PointIndex {
 public:
  explicit PointIndex(std::span<const SaddlePoint> points) {
    for (const SaddlePoint& point : points) {
      columns_ = std::max(columns_, cell(point.pixel.x()) + 1);
      rows_ = std::max(rows_, cell(point.pixel.y()) + 1);
    }
    cells_.resize(static_cast<std::size_t>(columns_) * rows_);
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
      cells_[cell(points[i].pixel.y()) * columns_ + cell(points[i].pixel.x())].push_back(i);
    }
  }

  int width_px() const { return kCell_px * std::max(columns_, rows_); }

  // Calls visit with all points within a square about the place, and a few others.
  template <typename Visit>
  void visit_near(const Vector2d& place, double half_width_px, const Visit& visit) const {
    const int right = std::min(cell(place.x() + half_width_px), columns_ - 1);
    const int bottom = std::min(cell(place.y() + half_width_px), rows_ - 1);
    for (int row = cell(place.y() - half_width_px); row <= bottom; ++row) {
      for (int column = cell(place.x() - half_width_px); column <= right; ++column) {
        for (const int point : cells_[row * columns_ + column]) visit(point);
      }
    }
  }

 private:
  static constexpr int kCell_px = 16;
  static int cell(double px) { return std::max(0, static_cast<int>(px / kCell_px)); }

  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<int>> cells_;
};

using Nodes = std::map<Node, int>;  // the index of the point at each

class LatticeGrowth {
 public:
  explicit LatticeGrowth(std::span<const SaddlePoint> points)
      : points_(points), index_(points), is_taken_(points.size()) {}

  // Empty where less than 3x3 nodes are found; otherwise they are taken.
  Nodes grow_from(int seed) {
    constexpr std::size_t kLeastNodes = 9;
    if (is_taken_[seed]) return {};
    nodes_.clear();
    take({0, 0}, seed);
    if (has_neighbours_along(seed, {1, 0}) && has_neighbours_along(seed, {0, 1})) spread();
    if (nodes_.size() >= kLeastNodes) return nodes_;
    for (const auto& [node, point] : nodes_) is_taken_[point] = false;
    return {};
  }

 private:
  void spread() {
    std::vector<Node> front;
    for (const auto& [node, point] : nodes_) front.push_back(node);
    while (!front.empty()) {
      std::vector<Node> next;
      for (const Node& node : front) {
        for (const Node& step : kSteps) {
          if (!nodes_.contains(node + step) && take(node + step, nearest_to_foretold(node, step))) {
            next.push_back(node + step);
          }
        }
      }
      front = std::move(next);
    }
  }

  bool take(const Node& node, int point) {
    if (point < 0) return false;
    nodes_[node] = point;
    is_taken_[point] = true;
    return true;
  }

  // Takes those that it has.
  bool has_neighbours_along(int seed, const Node& step) {
    const bool is_forward = take(step, nearest_along(seed, step));
    const Node back{-step.right, -step.down};
    return take(back, nearest_along(seed, back)) || is_forward;
  }

  Vector2d along_edge(int seed, const Node& step) const {
    const auto& edges_rad = points_[seed].edges_rad;
    // As axes, too, the edges shall turn clockwise from the first to the second.
    const double down_rad = edges_rad[1] < edges_rad[0] ? edges_rad[1] + std::numbers::pi : edges_rad[1];
    const double angle_rad = step.right != 0 ? edges_rad[0] : down_rad;
    return (step.right + step.down) * Vector2d(std::cos(angle_rad), std::sin(angle_rad));
  }

  // From the seed along one of its edges, or -1.
  int nearest_along(int seed, const Node& step) const {
    constexpr double kMostSlope = 0.25, kLeast_px = 3, kFirst_px = 30;
    const Vector2d along = along_edge(seed, step), start = points_[seed].pixel;
    int nearest = -1;
    for (double reach_px = kFirst_px; nearest < 0 && reach_px < 2 * index_.width_px(); reach_px *= 2) {
      double least_px = reach_px;
      index_.visit_near(start, reach_px, [&](int i) {
        const Vector2d way = points_[i].pixel - start;
        const double length_px = along.dot(way);
        if (length_px < kLeast_px || length_px > least_px || is_taken_[i]) return;
        const double aside_px = std::abs(along.x() * way.y() - along.y() * way.x());
        if (aside_px > kMostSlope * length_px || !may_be_neighbours(points_[seed], points_[i])) return;
        nearest = i;
        least_px = length_px;
      });
    }
    return nearest;
  }

  const Vector2d* pixel_of(const Node& node) const {
    const auto found = nodes_.find(node);
    return found == nodes_.end() ? nullptr : &points_[found->second].pixel;
  }

  // The mean of the steps of the same direction behind this one and at either side.
  std::optional<Vector2d> foretold_step(const Node& node, const Node& step) const {
    Vector2d sum = Vector2d::Zero();
    int count = 0;
    const Node aside{step.down, step.right};
    for (const Node& start : {node - step, node + aside, node - aside}) {
      const Vector2d *from = pixel_of(start), *to = pixel_of(start + step);
      if (!from || !to) continue;
      sum += *to - *from;
      ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / count;
  }

  int nearest_to_foretold(const Node& node, const Node& step) const {
    constexpr double kTolerance = 0.35;  // of a step
    const auto foretold = foretold_step(node, step);
    if (!foretold) return -1;
    const SaddlePoint& start = points_[nodes_.at(node)];
    const Vector2d place = start.pixel + *foretold;
    int nearest = -1;
    double least_px = kTolerance * foretold->norm();
    index_.visit_near(place, least_px, [&](int i) {
      const double distance_px = (points_[i].pixel - place).norm();
      if (distance_px > least_px || is_taken_[i] || !may_be_neighbours(start, points_[i])) return;
      nearest = i;
      least_px = distance_px;
    });
    return nearest;
  }

  std::span<const SaddlePoint> points_;
  PointIndex index_;
  std::vector<bool> is_taken_;
  Nodes nodes_;
};

// Borders of a rectangle, the last line included.
struct Borders {
  int left, right, top, bottom;
};

using NodePixels = std::map<Node, Vector2d>;

double missing_share(const NodePixels& nodes, const Borders& line) {
  int missing = 0, count = 0;
  for (int down = line.top; down <= line.bottom; ++down) {
    for (int right = line.left; right <= line.right; ++right) {
      missing += nodes.contains({right, down}) ? 0 : 1;
      ++count;
    }
  }
  return static_cast<double>(missing) / count;
}

Borders borders_of(const Lattice& lattice) {
  Borders b{lattice[0].right, lattice[0].right, lattice[0].down, lattice[0].down};
  for (const LatticeNode& node : lattice) {
    b = {std::min(b.left, node.right), std::max(b.right, node.right), std::min(b.top, node.down),
         std::max(b.bottom, node.down)};
  }
  return b;
}

// The line at a border that lacks most nodes: its share of them, and what is left without it.
struct EmptiestLine {
  double missing;
  Borders rest;
};

EmptiestLine emptiest_line(const NodePixels& nodes, const Borders& b) {
  const std::array<EmptiestLine, 4> lines{
      {{missing_share(nodes, {b.left, b.left, b.top, b.bottom}), {b.left + 1, b.right, b.top, b.bottom}},
       {missing_share(nodes, {b.right, b.right, b.top, b.bottom}), {b.left, b.right - 1, b.top, b.bottom}},
       {missing_share(nodes, {b.left, b.right, b.top, b.top}), {b.left, b.right, b.top + 1, b.bottom}},
       {missing_share(nodes, {b.left, b.right, b.bottom, b.bottom}), {b.left, b.right, b.top, b.bottom - 1}}}};
  return *std::ranges::max_element(lines, {}, &EmptiestLine::missing);
}

// Does each step go on like the one before, in rows and columns? Steep views change steps by up to a third.
bool is_even(const NodeRectangle& r) {
  constexpr double kMostChange = 0.4;  // of a step
  const auto goes_on = [&](int node, int next) {
    const Vector2d before = r.pixels[node] - r.pixels[node - next], after = r.pixels[node + next] - r.pixels[node];
    return (after - before).norm() < kMostChange * 0.5 * (after + before).norm();
  };
  for (int row = 0; row < r.rows; ++row) {
    for (int column = 0; column < r.columns; ++column) {
      const int node = row * r.columns + column;
      if (column > 0 && column + 1 < r.columns && !goes_on(node, 1)) return false;
      if (row > 0 && row + 1 < r.rows && !goes_on(node, r.columns)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Lattice> grow_lattices(std::span<const SaddlePoint> points) {
  constexpr std::size_t kMostSeeds = 600;  // of a board, some are among the strongest
  LatticeGrowth growth(points);
  std::vector<Lattice> lattices;
  const int end = static_cast<int>(std::min(points.size(), kMostSeeds));
  for (int seed = 0; seed < end; ++seed) {
    const Nodes nodes = growth.grow_from(seed);
    if (nodes.empty()) continue;
    Lattice& lattice = lattices.emplace_back();
    for (const auto& [node, point] : nodes) lattice.push_back({node.right, node.down, points[point].pixel});
  }
  return lattices;
}

std::optional<NodeRectangle> whole_rectangle(const Lattice& lattice) {
  constexpr double kLeastMissing = 0.6;
  constexpr int kLeastSide = 3;
  if (lattice.empty()) return std::nullopt;
  NodePixels nodes;
  for (const LatticeNode& node : lattice) nodes[{node.right, node.down}] = node.pixel;
  Borders b = borders_of(lattice);
  const auto is_too_small = [&] { return std::min(b.right - b.left, b.bottom - b.top) + 1 < kLeastSide; };
  while (!is_too_small() && missing_share(nodes, b) > 0) {
    const EmptiestLine line = emptiest_line(nodes, b);
    if (line.missing < kLeastMissing) return std::nullopt;
    b = line.rest;
  }
  if (is_too_small()) return std::nullopt;
  NodeRectangle rectangle{b.right - b.left + 1, b.bottom - b.top + 1, {}};
  for (int down = b.top; down <= b.bottom; ++down) {
    for (int right = b.left; right <= b.right; ++right) rectangle.pixels.push_back(nodes.at({right, down}));
  }
  if (!is_even(rectangle)) return std::nullopt;
  return rectangle;
}

}  // namespace alidade
