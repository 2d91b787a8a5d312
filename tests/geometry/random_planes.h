// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "geometry/plane_constraint.h"
#include "tests/geometry/random_geometry.h"

namespace alidade::test {

/// A random body at T_world_body, plane_counts[i] planes through its i-th marker in random directions, each off by
/// sigma_m (0: exact, with the weight of 0.3 mm). Markers about 0.15 m from the body's origin.
inline std::vector<PlaneConstraint> random_planes(RandomGeometry& random, const Eigen::Isometry3d& T_world_body,
                                                  std::span<const int> plane_counts, double sigma_m) {
  const double weight = 1.0 / (sigma_m > 0 ? sigma_m * sigma_m : 9e-8);
  std::vector<PlaneConstraint> constraints;
  for (const int planes : plane_counts) {
    const Eigen::Vector3d p_body = random.vector(0.1);
    for (int i = 0; i < planes; ++i) {
      const Eigen::Vector3d n = random.direction();
      constraints.push_back({p_body, {n, n.dot(T_world_body * p_body) + random.normal(sigma_m)}, weight});
    }
  }
  return constraints;
}

/// The planes of a pinhole camera's pixels of points: two through its centre for each, off by `sigma` (in focal
/// lengths). The camera's frame is the world, the points' the body.
inline std::vector<PlaneConstraint> pixel_planes(RandomGeometry& random, const Eigen::Isometry3d& T_camera_scene,
                                                 std::span<const Eigen::Vector3d> points_scene, double sigma) {
  std::vector<PlaneConstraint> constraints;
  for (const Eigen::Vector3d& p_scene : points_scene) {
    const Eigen::Vector3d p = T_camera_scene * p_scene;
    const double weight = 1.0 / std::max(1e-8, sigma * sigma) / (p.z() * p.z());
    const Eigen::Vector3d across_x(1, 0, -(p.x() / p.z() + random.normal(sigma)));
    const Eigen::Vector3d across_y(0, 1, -(p.y() / p.z() + random.normal(sigma)));
    constraints.push_back({p_scene, {across_x.normalized(), 0.0}, weight * across_x.squaredNorm()});
    constraints.push_back({p_scene, {across_y.normalized(), 0.0}, weight * across_y.squaredNorm()});
  }
  return constraints;
}

}  // namespace alidade::test
