// SPDX-License-Identifier: Apache-2.0
#include "estimation/pointwise_sightings.h"

#include <algorithm>
#include <limits>

#include <Eigen/LU>

namespace alidade {
namespace {

// ∂pixel/∂xi: p_camera' = exp(-θ)(p_camera - δ) moves by minus identity and skew(p_camera).
Eigen::Matrix<double, 2, 6> pose_jacobian(const Eigen::Matrix<double, 2, 3>& J_pixel_point, const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 2, 6> J;
  J.leftCols<3>() = -J_pixel_point;
  for (int row = 0; row < 2; ++row) J.row(row).tail<3>() = J_pixel_point.row(row).cross(p);
  return J;
}

}  // namespace

PointwiseSightings::PointwiseSightings(const Camera& camera, std::span<const PointObservation> observations,
                                       double variance_factor, MapUncertainty map_uncertainty)
    : camera_(camera),
      observations_(observations),
      variance_factor_(variance_factor),
      map_uncertainty_(map_uncertainty),
      sightings_(observations.size()),
      chi2_(static_cast<Eigen::Index>(observations.size())) {
  if (map_uncertainty == MapUncertainty::Ignored) return;
  if (std::all_of(observations.begin(), observations.end(), has_exact_point)) return;
  points_.reserve(observations.size());
  for (const PointObservation& o : observations) points_.emplace_back(o.p_world, o.covariance_world, o.seen_from);
}

void PointwiseSightings::linearise(const Eigen::Isometry3d& T_camera_world) {
  for (Eigen::Index i = 0; i < chi2_.size(); ++i) {
    chi2_(i) = std::numeric_limits<double>::infinity();
    const auto s = sight(T_camera_world, index(i));
    if (!s) continue;
    Sighting& sighting = sightings_[index(i)];
    sighting.in_px << pose_jacobian(s->J_pixel_point, s->p_camera), s->residual;
    sighting.R_inverse = s->R.inverse();
    chi2_(i) = s->residual.dot(sighting.R_inverse * s->residual);
  }
}

NormalEquations PointwiseSightings::weighted_sum(const Eigen::ArrayXd& weight) const {
  Eigen::Matrix<double, 7, 7> sum = Eigen::Matrix<double, 7, 7>::Zero();
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    if (weight(i) == 0.0) continue;
    const auto& [rows, R_inverse] = sightings_[index(i)];
    const Eigen::Matrix<double, 2, 7> weighted = weight(i) * R_inverse * rows;
    for (int column = 0; column < 7; ++column) {
      for (int row = column; row < 7; ++row) sum(row, column) += rows.col(row).dot(weighted.col(column));
    }
  }
  return normal_equations(sum);
}

std::optional<UncertainSighting> PointwiseSightings::sight(const Eigen::Isometry3d& T_camera_world, std::size_t i) {
  const PointObservation& o = observations_[i];
  const double variance = variance_factor_ * o.sigma_px * o.sigma_px;
  if (!points_.empty() && !points_[i].is_certain()) {
    if (map_uncertainty_ == MapUncertainty::Refitted) points_[i].refit(camera_, T_camera_world, o.pixel, variance);
    return points_[i].linearise(camera_, T_camera_world, o.pixel, variance);
  }
  const Eigen::Vector3d p_camera = T_camera_world.linear() * o.p_world + T_camera_world.translation();
  const auto projection = project(camera_, p_camera);
  if (!projection) return std::nullopt;
  return UncertainSighting{o.pixel - projection->pixel, p_camera, projection->J_pixel_point,
                           variance * Eigen::Matrix2d::Identity()};
}

}  // namespace alidade
