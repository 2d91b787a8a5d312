// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "evaluation/association.h"
#include "evaluation/statistics.h"

namespace alidade {

/// The errors of the camera tracker's paper.
struct PathErrors {
  double path_length_m = 0;         ///< of the truth, from associated pose to associated pose
  ErrorSeries translation_percent;  ///< |d̂ − d| in percent of path_length_m
  ErrorSeries rotation_deg;         ///< norm of the differences of roll, pitch and yaw
};

/// Roll, pitch and yaw (rad) of R = Rz(yaw) Ry(pitch) Rx(roll); pitch in [−π/2, π/2]. At pitch ±π/2 roll is 0.
Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& R);

/// The angles are those of R_world_camera, each difference taken the short way round. They are the paper's, and grow
/// without meaning near pitch ±90°: prefer AbsoluteErrors::rotation_deg. Percentages are 0 where the path has no
/// length. Throws std::invalid_argument for unequal lengths.
/// Source: Mehralian & Soryani, section 4.1.
PathErrors path_errors(const PairedTrajectories& pairs);

}  // namespace alidade
