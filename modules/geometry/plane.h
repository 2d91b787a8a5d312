// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace alidade {

/// All points p with normal · p = offset.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length
  double offset = 0.0;                                ///< m
};

/// The same plane in another frame.
inline Plane operator*(const Eigen::Isometry3d& T_target_source, const Plane& plane) {
  const Eigen::Vector3d normal = T_target_source.linear() * plane.normal;
  return {normal, plane.offset + normal.dot(T_target_source.translation())};
}

/// Signed distance of a point from the plane, in m; positive on the side to which the normal points.
inline double distance(const Plane& plane, const Eigen::Vector3d& p) {
  return plane.normal.dot(p) - plane.offset;
}

}  // namespace alidade
