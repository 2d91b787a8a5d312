// SPDX-License-Identifier: Apache-2.0
#include "geometry/rotation.h"

#include <cmath>

namespace alidade {
namespace {

constexpr double kSmallAngle = 1e-4;  // rad; below it the Taylor terms left out are under 1e-17

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d S = skew(phi);
  const bool small = angle < kSmallAngle;
  const double a = small ? 1.0 - angle * angle / 6.0 : std::sin(angle) / angle;
  const double half_sine = std::sin(0.5 * angle);
  const double b = small ? 0.5 - angle * angle / 24.0 : 2.0 * half_sine * half_sine / (angle * angle);
  return Eigen::Matrix3d::Identity() + a * S + b * S * S;
}

Eigen::Vector3d log_so3(const Eigen::Matrix3d& R) {
  // The quaternion keeps the small sine of a small angle and the axis near π alike.
  Eigen::Quaterniond q(R);
  if (q.w() < 0) q.coeffs() *= -1;
  const double sine = q.vec().norm();
  if (sine < 1e-9) return 2.0 * q.vec();
  return 2.0 * std::atan2(sine, q.w()) / sine * q.vec();
}

Eigen::Matrix3d right_jacobian_so3(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d S = skew(phi);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() - 0.5 * S + S * S / 6.0;
  const double squared = angle * angle;
  return Eigen::Matrix3d::Identity() - (1.0 - std::cos(angle)) / squared * S +
         (angle - std::sin(angle)) / (squared * angle) * S * S;
}

}  // namespace alidade
