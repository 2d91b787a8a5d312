// SPDX-License-Identifier: Apache-2.0
#include "geometry/rotation.h"

#include <cmath>

namespace alidade {
namespace {

constexpr double kSmallAngle = 1e-4;  // rad; below it the Taylor terms left out are under 1e-20

// (1 - cos angle) / angle², without the cancellation.
double one_minus_cosine_over_square(double angle) {
  if (angle < kSmallAngle) return 0.5 - angle * angle / 24.0;
  const double half_sine = std::sin(0.5 * angle);
  return 2.0 * half_sine * half_sine / (angle * angle);
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d S = skew(phi);
  const double a = angle < kSmallAngle ? 1.0 - angle * angle / 6.0 : std::sin(angle) / angle;
  const double b = one_minus_cosine_over_square(angle);
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
  const double cube = angle * angle * angle;
  const double c = angle < kSmallAngle ? 1.0 / 6.0 : (angle - std::sin(angle)) / cube;
  return Eigen::Matrix3d::Identity() - one_minus_cosine_over_square(angle) * S + c * S * S;
}

}  // namespace alidade
