// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "camera/line_detector.h"
#include "camera/measurement.h"
#include "geometry/pose.h"
#include "geometry/rigid_body.h"

namespace alidade {

/// How a detector's reading of a marker at `p_body` (m) moves with the body's pose, per m and rad of the right
/// perturbation of T_world_body; empty where the detector does not see the marker.
std::optional<Eigen::Matrix<double, 1, 6>> reading_jacobian(const LineDetector& detector,
                                                            const Eigen::Isometry3d& T_world_body,
                                                            const Eigen::Vector3d& p_body);

/// Fisher information of T_world_body (right perturbation, m and rad) in readings of the body's markers made at that
/// pose, each with its sigma (0: the detector's), with independent Gaussian errors. Readings of markers that are not
/// the body's, and of markers that their detector does not see, tell nothing. Throws std::invalid_argument for a
/// reading by a detector that is not there or without any sigma.
Matrix6d pose_information(std::span<const LineDetector> detectors, const RigidBody& body,
                          const Eigen::Isometry3d& T_world_body, std::span<const LineReading> readings);

/// The least mean squares that an unbiased estimate can have (Cramér–Rao); their roots are its RMS.
struct PoseBound {
  double position_m2 = 0.0;    ///< E |error of the translation|²
  double rotation_rad2 = 0.0;  ///< E |rotation vector of the error|²
};

/// From the information of one frame; of many frames, take the mean. Empty where the pose is not determined.
std::optional<PoseBound> pose_bound(const Matrix6d& information);

}  // namespace alidade
