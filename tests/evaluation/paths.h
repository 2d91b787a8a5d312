// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "geometry/rotation.h"
#include "geometry/trajectory.h"

namespace alidade::test {

inline StampedPose pose_at_time(double seconds, const Eigen::Vector3d& centre,
                                const Eigen::Vector3d& phi = Eigen::Vector3d::Zero()) {
  StampedPose pose;
  pose.time = Timestamp(from_seconds(seconds));
  pose.T_world_camera.linear() = exp_so3(phi);
  pose.T_world_camera.translation() = centre;
  return pose;
}

/// A winding path: `count` poses, `period_s` apart, from `start_s`.
inline Trajectory winding_path(int count, double period_s = 0.1, double start_s = 0.0) {
  Trajectory path;
  for (int i = 0; i < count; ++i) {
    const double t = period_s * i;
    path.push_back(pose_at_time(start_s + t, {std::cos(t), 2.0 * std::sin(0.7 * t), 0.5 * t},
                                {0.3 * std::sin(t), 0.2 * t, 0.1 * std::cos(t)}));
  }
  return path;
}

}  // namespace alidade::test
