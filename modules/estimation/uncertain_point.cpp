// SPDX-License-Identifier: Apache-2.0
#include "estimation/uncertain_point.h"

#include <Eigen/LU>

namespace alidade {
namespace {

// v / |v|², its own inverse, and its Jacobian.
Eigen::Vector3d inverted(const Eigen::Vector3d& v) {
  return v / v.squaredNorm();
}

Eigen::Matrix3d jacobian_of_inverted(const Eigen::Vector3d& v) {
  const double square = v.squaredNorm();
  return Eigen::Matrix3d::Identity() / square - 2.0 / (square * square) * v * v.transpose();
}

}  // namespace

UncertainPoint::UncertainPoint(const Eigen::Vector3d& p_world, const Eigen::Matrix3d& covariance_world,
                               const std::optional<Eigen::Vector3d>& seen_from)
    : is_certain_(covariance_world.isZero(0.0)),
      is_inverse_(seen_from.has_value()),
      u_map_(p_world),
      P_u_(covariance_world) {
  if (is_inverse_) {
    origin_ = *seen_from;
    const Eigen::Matrix3d J = jacobian_of_inverted(p_world - origin_);
    u_map_ = inverted(p_world - origin_);
    P_u_ = J * covariance_world * J.transpose();
  }
  u_ = u_map_;
}

Eigen::Vector3d UncertainPoint::p_world() const {
  return is_inverse_ ? Eigen::Vector3d(origin_ + inverted(u_)) : u_;
}

Eigen::Matrix3d UncertainPoint::J_world_u() const {
  return is_inverse_ ? jacobian_of_inverted(u_) : Eigen::Matrix3d::Identity();
}

std::optional<UncertainSighting> UncertainPoint::linearise(const Camera& camera,
                                                           const Eigen::Isometry3d& T_camera_world,
                                                           const Eigen::Vector2d& pixel, double variance_px2) const {
  UncertainSighting s;
  s.p_camera = T_camera_world * p_world();
  const auto projection = project(camera, s.p_camera);
  if (!projection) return std::nullopt;
  s.J_pixel_point = projection->J_pixel_point;
  const Eigen::Matrix<double, 2, 3> J_u = s.J_pixel_point * T_camera_world.linear() * J_world_u();
  s.residual = pixel - projection->pixel + J_u * (u_ - u_map_);
  s.R = variance_px2 * Eigen::Matrix2d::Identity() + J_u * P_u_ * J_u.transpose();
  return s;
}

void UncertainPoint::refit(const Camera& camera, const Eigen::Isometry3d& T_camera_world, const Eigen::Vector2d& pixel,
                           double variance_px2) {
  const auto s = linearise(camera, T_camera_world, pixel, variance_px2);
  if (!s) return;
  const Eigen::Matrix<double, 2, 3> J_u = s->J_pixel_point * T_camera_world.linear() * J_world_u();
  u_ = u_map_ + P_u_ * J_u.transpose() * s->R.inverse() * s->residual;
}

}  // namespace alidade
