// SPDX-License-Identifier: Apache-2.0
#include "geometry/trajectory.h"

#include <algorithm>

namespace alidade {

double path_length(const Trajectory& trajectory) {
  double length = 0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += (trajectory[i].T_world_camera.translation() - trajectory[i - 1].T_world_camera.translation()).norm();
  }
  return length;
}

std::optional<Eigen::Isometry3d> pose_at(const Trajectory& trajectory, Timestamp time,
                                         RecordingClock::duration longest_gap) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), time,
                                      [](const StampedPose& pose, Timestamp t) { return pose.time < t; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->time == time) return after->T_world_camera;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (after->time - before->time > longest_gap) return std::nullopt;
  const double fraction = to_seconds(time - before->time) / to_seconds(after->time - before->time);
  return interpolate(before->T_world_camera, after->T_world_camera, fraction);
}

std::optional<Vector6d> twist_at(const Trajectory& trajectory, Timestamp time, RecordingClock::duration half_span,
                                 RecordingClock::duration longest_gap) {
  const auto before = pose_at(trajectory, time - half_span, longest_gap);
  const auto after = pose_at(trajectory, time + half_span, longest_gap);
  if (!before || !after) return std::nullopt;
  Vector6d twist = difference(*before, *after);
  twist.head<3>() = interpolate(*before, *after, 0.5).linear().transpose() * before->linear() * twist.head<3>();
  return twist / (2.0 * to_seconds(half_span));
}

}  // namespace alidade
