// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/saddle_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

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

// At the next corner the same edges go on with bright and dark exchanged. Far weaker are noise and the steps of edges.
bool may_be_neighbours(const SaddlePoint& one, const SaddlePoint& other) {
  constexpr double kMostTurn_rad = 0.5;  // rings on squares of a few pixels are that coarse
  constexpr double kLeastRatio = 0.25;
  if (other.strength < kLeastRatio * one.strength) return false;
  const auto turn_rad = [&](int i, int j) { return angle_between_lines(one.edges_rad[i], other.edges_rad[j]); };
  const double first_rad = turn_rad(0, 1), second_rad = turn_rad(1, 0);
  const bool is_nearer_exchanged = first_rad + second_rad < turn_rad(0, 0) + turn_rad(1, 1);
  return is_nearer_exchanged && std::max(first_rad, second_rad) < kMostTurn_rad;
}

class LatticeGrowth {
 public:
  LatticeGrowth(std::span<const SaddlePoint> points, const std::vector<bool>& is_taken)
      : points_(points), is_taken_(is_taken) {}

  // The indices of points by node.
  std::map<Node, int> grow_from(int seed) {
    nodes_ = {{{0, 0}, seed}};
    is_taken_[seed] = true;
    for (const Node& step : kSteps) take({step.right, step.down}, nearest_along(seed, step));
    if (nodes_.size() < 3) return {};
    std::vector<Node> front;
    for (const auto& [node, point] : nodes_) front.push_back(node);
    while (!front.empty()) {
      std::vector<Node> next;
      for (const Node& node : front) {
        for (const Node& step : kSteps) {
          const Node neighbour = node + step;
          if (!nodes_.contains(neighbour) && take(neighbour, nearest_to_foretold(node, step)))
            next.push_back(neighbour);
        }
      }
      front = std::move(next);
    }
    return nodes_;
  }

 private:
  bool take(const Node& node, int point) {
    if (point < 0) return false;
    nodes_[node] = point;
    is_taken_[point] = true;
    return true;
  }

  // From the seed along one of its edges, or -1.
  int nearest_along(int seed, const Node& step) const {
    constexpr double kMostSlope = 0.25, kLeast_px = 3;
    const double angle_rad = points_[seed].edges_rad[step.right != 0 ? 0 : 1];
    // The edges as axes must turn clockwise, too.
    const bool is_turned = points_[seed].edges_rad[1] < points_[seed].edges_rad[0] && step.right == 0;
    const double sign = (step.right + step.down) * (is_turned ? -1 : 1);
    const Vector2d along(sign * std::cos(angle_rad), sign * std::sin(angle_rad));
    int nearest = -1;
    double least_px = std::numeric_limits<double>::infinity();
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
      const Vector2d way = points_[i].pixel - points_[seed].pixel;
      const double length_px = along.dot(way);
      if (length_px < kLeast_px || length_px > least_px || is_taken_[i]) continue;
      const double aside_px = std::abs(along.x() * way.y() - along.y() * way.x());
      if (aside_px > kMostSlope * length_px || !may_be_neighbours(points_[seed], points_[i])) continue;
      nearest = i;
      least_px = length_px;
    }
    return nearest;
  }

  const Vector2d* pixel_of(const Node& node) const {
    const auto found = nodes_.find(node);
    return found == nodes_.end() ? nullptr : &points_[found->second].pixel;
  }

  // The steps of the same direction behind this one and at either side, on the average.
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
    const auto way = foretold_step(node, step);
    if (!way) return -1;
    const int start = nodes_.at(node);
    const Vector2d foretold = points_[start].pixel + *way;
    int nearest = -1;
    double least_px2 = kTolerance * kTolerance * way->squaredNorm();
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
      const double distance_px2 = (points_[i].pixel - foretold).squaredNorm();
      if (distance_px2 > least_px2 || is_taken_[i] || !may_be_neighbours(points_[start], points_[i])) continue;
      nearest = i;
      least_px2 = distance_px2;
    }
    return nearest;
  }

  std::span<const SaddlePoint> points_;
  std::vector<bool> is_taken_;
  std::map<Node, int> nodes_;
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

Borders without_emptiest_line(const NodePixels& nodes, Borders b) {
  const std::array<double, 4> missing{missing_share(nodes, {b.left, b.left, b.top, b.bottom}),
                                      missing_share(nodes, {b.right, b.right, b.top, b.bottom}),
                                      missing_share(nodes, {b.left, b.right, b.top, b.top}),
                                      missing_share(nodes, {b.left, b.right, b.bottom, b.bottom})};
  switch (std::ranges::max_element(missing) - missing.begin()) {
    case 0:
      ++b.left;
      break;
    case 1:
      --b.right;
      break;
    case 2:
      ++b.top;
      break;
    default:
      --b.bottom;
  }
  return b;
}

}  // namespace

std::vector<Lattice> grow_lattices(std::span<const SaddlePoint> points) {
  constexpr std::size_t kLeastNodes = 9;
  std::vector<bool> is_taken(points.size());
  std::vector<Lattice> lattices;
  for (int seed = 0; seed < static_cast<int>(points.size()); ++seed) {
    if (is_taken[seed]) continue;
    const auto nodes = LatticeGrowth(points, is_taken).grow_from(seed);
    if (nodes.size() < kLeastNodes) continue;
    Lattice& lattice = lattices.emplace_back();
    for (const auto& [node, point] : nodes) {
      lattice.push_back({node.right, node.down, points[point].pixel});
      is_taken[point] = true;
    }
  }
  return lattices;
}

std::optional<NodeRectangle> whole_rectangle(const Lattice& lattice, int most_outside) {
  if (lattice.empty()) return std::nullopt;
  NodePixels nodes;
  for (const LatticeNode& node : lattice) nodes[{node.right, node.down}] = node.pixel;
  Borders b = borders_of(lattice);
  while (missing_share(nodes, b) > 0) {
    if (std::min(b.right - b.left, b.bottom - b.top) < 2) return std::nullopt;
    b = without_emptiest_line(nodes, b);
  }
  NodeRectangle rectangle{b.right - b.left + 1, b.bottom - b.top + 1, {}};
  const int inside = rectangle.columns * rectangle.rows;
  if (std::min(rectangle.columns, rectangle.rows) < 3) return std::nullopt;
  if (static_cast<int>(nodes.size()) - inside > most_outside) return std::nullopt;
  for (int down = b.top; down <= b.bottom; ++down) {
    for (int right = b.left; right <= b.right; ++right) rectangle.pixels.push_back(nodes.at({right, down}));
  }
  return rectangle;
}

}  // namespace alidade
