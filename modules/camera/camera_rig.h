// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "geometry/pose.h"

namespace alidade {

/// A calibrated camera, where it sits on its rig, and how well both are known.
struct RigCamera {
  std::string name;
  Camera camera;
  Eigen::Isometry3d T_rig_camera = Eigen::Isometry3d::Identity();
  /// Of intrinsics(camera), in their order and squared units; rows and columns of parameters that were held are 0.
  std::optional<Eigen::MatrixXd> intrinsics_covariance{};
  /// Of the right perturbation xi = (translation, rotation) of T_rig_camera; m², m·rad, rad².
  std::optional<Matrix6d> pose_covariance{};
  double clock_offset_s = 0;  ///< added to the camera's times it gives the rig's
};

/// Cameras that stand rigidly together.
struct CameraRig {
  std::vector<RigCamera> cameras;
};

}  // namespace alidade
