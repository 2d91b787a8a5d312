// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace alidade {

/// Two unit vectors orthogonal to the unit vector `direction` and to each other: the axes along which small errors of a
/// direction are told, in rad. Right-handed: column 0 × column 1 = direction. Smooth in all but −z.
/// Source: Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
inline Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& direction) {
  const double sign = std::copysign(1.0, direction.z());
  const double a = -1.0 / (sign + direction.z());
  const double b = direction.x() * direction.y() * a;
  Eigen::Matrix<double, 3, 2> basis;
  basis << 1.0 + sign * direction.x() * direction.x() * a, b,  //
      sign * b, sign + direction.y() * direction.y() * a,      //
      -sign * direction.x(), -direction.y();
  return basis;
}

}  // namespace alidade
