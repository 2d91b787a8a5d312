// SPDX-License-Identifier: Apache-2.0
#include "uav/window/direction_grid.h"

#include "geometry/tangent.h"

namespace alidade {

DirectionGrid::DirectionGrid(std::span<const Eigen::Vector3d> directions) {
  if (directions.empty()) return;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& d : directions) sum += d;
  if (sum.norm() > 0.0) centre_ = sum.normalized();
  axes_ = tangent_basis(centre_);
  is_sorted_ = std::all_of(directions.begin(), directions.end(),
                           [&](const Eigen::Vector3d& d) { return centre_.dot(d) > kLeastDepth; });
  side_ = 1;
  std::vector<Eigen::Vector2d> places(directions.size(), Eigen::Vector2d::Zero());
  if (is_sorted_) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      places[i] = axes_.transpose() * directions[i] / centre_.dot(directions[i]);
    }
    Eigen::Vector2d greatest = corner_ = places.front();
    for (const Eigen::Vector2d& place : places) {
      corner_ = corner_.cwiseMin(place);
      greatest = greatest.cwiseMax(place);
    }
    side_ =
        std::clamp(static_cast<int>(std::ceil(std::sqrt(static_cast<double>(places.size())))), 1, kMostCellsPerSide);
    inverse_cell_ = side_ / std::max((greatest - corner_).maxCoeff(), 1e-9);
  }
  const auto cell_at = [&](const Eigen::Vector2d& place) {
    const int x = std::min(cell_of(place.x() - corner_.x()), side_ - 1);
    const int y = std::min(cell_of(place.y() - corner_.y()), side_ - 1);
    return static_cast<std::size_t>(y * side_ + x);
  };
  starts_.assign(static_cast<std::size_t>(side_ * side_) + 1, 0);
  for (const Eigen::Vector2d& place : places) ++starts_[cell_at(place) + 1];
  for (std::size_t cell = 1; cell < starts_.size(); ++cell) starts_[cell] += starts_[cell - 1];
  items_.resize(places.size());
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t i = 0; i < places.size(); ++i) items_[next[cell_at(places[i])]++] = i;
}

}  // namespace alidade
