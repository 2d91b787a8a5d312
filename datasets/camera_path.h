// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace alidade {

/// How a camera moves through the furnished room; all smooth, all six degrees of freedom except where said.
enum class PathKind {
  Orbit,      ///< round the table, looking at it, with changing distance and height
  Sweep,      ///< to and fro before the table, looking across it
  Rotation,   ///< turns on the spot: three degrees of freedom, no parallax
  StopAndGo,  ///< the orbit, with rests
};

/// T_world_camera at `time_s` (any number, also negative). `speed_m_s`: the typical speed of the centre; of a rotation
/// the typical rate in rad/s. Starts before the table's front.
Eigen::Isometry3d camera_on_path(PathKind kind, double speed_m_s, double time_s);

}  // namespace alidade
