// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/time.h"
#include "geometry/pose.h"

namespace alidade {

/// Where a camera (or body) was at one moment.
struct StampedPose {
  Timestamp time{};
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  /// Covariance of the perturbation xi = (translation, rotation) on the right of T_world_camera, camera axes;
  /// m², m·rad, rad².
  std::optional<Matrix6d> covariance;
};

/// Poses in order of time.
using Trajectory = std::vector<StampedPose>;

/// Sum of the distances between consecutive centres, in m; 0 for fewer than two poses.
double path_length(const Trajectory& trajectory);

/// The pose at `time`, interpolated between its neighbours (without covariance); empty outside the trajectory or in a
/// gap longer than `longest_gap`.
std::optional<Eigen::Isometry3d> pose_at(const Trajectory& trajectory, Timestamp time,
                                         RecordingClock::duration longest_gap);

/// How the camera moves at `time`: the difference of its poses `half_span` before and after, per second (m/s and rad/s,
/// along its own axes). Empty where pose_at is at one of them.
std::optional<Vector6d> twist_at(const Trajectory& trajectory, Timestamp time, RecordingClock::duration half_span,
                                 RecordingClock::duration longest_gap);

}  // namespace alidade
