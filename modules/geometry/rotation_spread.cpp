// SPDX-License-Identifier: Apache-2.0
#include "geometry/rotation_spread.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace alidade {

Eigen::Matrix3d spread_rotation(int i, int n) {
  constexpr double kPsi = 1.533751168755204288118041;
  const double s = i + 0.5;
  const double t = s / n;
  const double alpha = 2.0 * std::numbers::pi * s / std::numbers::sqrt2;
  const double beta = 2.0 * std::numbers::pi * s / kPsi;
  const double r = std::sqrt(t), q = std::sqrt(1.0 - t);
  return Eigen::Quaterniond(q * std::cos(beta), r * std::sin(alpha), r * std::cos(alpha), q * std::sin(beta))
      .toRotationMatrix();
}

}  // namespace alidade
