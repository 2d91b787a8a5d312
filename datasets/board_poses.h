// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "camera/camera.h"

namespace alidade {

/// Options of the poses in which a board is shown to a camera.
struct BoardPoseOptions {
  double most_tilt_deg = 45;  ///< of the board's normal against the optical axis; beyond it corners blur
  double most_roll_deg = 30;  ///< in the image
  double least_fill = 0.35;   ///< of the image's width or height by the board, where it is farthest
  double most_fill = 0.85;    ///< where it is nearest
  double margin_px = 4;       ///< between the board's extent and the image's border
  bool partial = false;       ///< a third of each board may lie outside the image
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const BoardPoseOptions& options);

/// Poses T_camera_board of a flat board whose print covers `extent_m` of its plane and faces the camera, as one would
/// hold it for a calibration: its centre goes over the cells of a grid on the image, in random order, with random tilt,
/// roll and distance; where it would not fit the image, it is moved towards the middle. The same seed gives the same
/// poses. Throws std::invalid_argument as validate, for count < 0, an empty extent and a camera with a fault.
std::vector<Eigen::Isometry3d> board_poses(const Camera& camera, const Eigen::AlignedBox2d& extent_m, int count,
                                           unsigned seed, const BoardPoseOptions& options = {});

}  // namespace alidade
