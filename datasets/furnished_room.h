// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "view/scene.h"

namespace alidade {

/// Options of the room.
struct RoomOptions {
  double finest_texel_m = 0.0013;  ///< resolution of what stands on the table; the walls' is coarser by 2.3
  std::uint64_t seed = 1;
};

/// A room of 6 × 5 × 2.8 m about the origin of its floor, z up: walls and floor with reliefs, a table in its middle
/// with boxes and balls on it, cupboards along the walls. Everything is textured, nothing is flat for long, and seen
/// from the inside there is no hole. The front of the table (towards −y) is kept free.
Scene make_furnished_room(const RoomOptions& options);

/// Height of the table's top and half of its extents, m.
inline constexpr double kTableTop_m = 0.75;
inline constexpr double kTableHalfWidth_m = 0.8;   ///< along x
inline constexpr double kTableHalfDepth_m = 0.45;  ///< along y

/// A marker of OpenCV's dictionary APRILTAG_36h11 (id 0) with a white rim. `side_m`: of its black square. The marker's
/// axes as OpenCV's: origin in its middle, x right, y up, z towards the viewer.
TexturedSurface make_marker(const Eigen::Isometry3d& T_world_marker, double side_m);

}  // namespace alidade
