// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace alidade {

/// Directions sorted into squares about their mean, about one in each, so that those near a direction are found at a
/// cost that does not grow with their number. Directions that spread over more than 70° about their mean are not
/// sorted: all of them are looked at.
class DirectionGrid {
 public:
  DirectionGrid() = default;
  explicit DirectionGrid(std::span<const Eigen::Vector3d> directions);  ///< of unit length

  /// Calls visit(index) for every direction within `radius_rad` of the unit direction `u`, and for some others, until
  /// it returns true. Returns whether it did.
  template <typename Visit>
  bool visit_near(const Eigen::Vector3d& u, double radius_rad, Visit visit) const {
    const double depth = centre_.dot(u), least_depth = depth - radius_rad;
    if (!is_sorted_ || least_depth < kLeastDepth) return visit_cells(0, side_ - 1, 0, side_ - 1, visit);
    const Eigen::Vector2d at = (axes_.transpose() * u) / depth - corner_;
    const double radius = radius_rad / (least_depth * least_depth);  // no angle looks larger in the plane
    const int x0 = cell_of(at.x() - radius), x1 = cell_of(at.x() + radius);
    const int y0 = cell_of(at.y() - radius), y1 = cell_of(at.y() + radius);
    return visit_cells(std::max(x0, 0), std::min(x1, side_ - 1), std::max(y0, 0), std::min(y1, side_ - 1), visit);
  }

 private:
  static constexpr double kLeastDepth = 0.3;
  static constexpr int kMostCellsPerSide = 64;

  int cell_of(double along) const {
    return static_cast<int>(std::floor(std::clamp(along * inverse_cell_, -1.0, static_cast<double>(side_))));
  }

  template <typename Visit>
  bool visit_cells(int x0, int x1, int y0, int y1, Visit& visit) const {
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const auto cell = static_cast<std::size_t>(y * side_ + x);
        for (std::size_t i = starts_[cell]; i < starts_[cell + 1]; ++i) {
          if (visit(items_[i])) return true;
        }
      }
    }
    return false;
  }

  bool is_sorted_ = false;
  int side_ = 0;  // cells along x and along y
  double inverse_cell_ = 0.0;
  Eigen::Vector3d centre_ = Eigen::Vector3d::UnitZ();
  Eigen::Matrix<double, 3, 2> axes_ = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();
  std::vector<std::size_t> starts_, items_;  // of each cell; the directions' indices, cell by cell
};

}  // namespace alidade
