// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/time.h"
#include "estimation/pose_update.h"
#include "geometry/pose.h"

namespace alidade {

using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// The filter's state: where the camera is and how it moves. The map is not part of it.
struct CameraState {
  Timestamp time{};
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Eigen::Vector3d v_world = Eigen::Vector3d::Zero();       ///< m/s
  Eigen::Vector3d omega_camera = Eigen::Vector3d::Zero();  ///< rad/s, body axes
  /// Of the error (xi of the pose: translation and rotation in camera axes; v_world; omega_camera); m, rad, s.
  Matrix12d covariance = Matrix12d::Identity();
};

/// Standard deviations of the accelerations that the constant-velocity model leaves out.
struct MotionNoise {
  double acceleration = 1.0;          ///< m/s²
  double angular_acceleration = 1.0;  ///< rad/s²
};

/// Where the camera will be at `time`: constant velocity, with the accelerations as noise. A time before the state's
/// is taken as the state's own.
/// Source: camera-tracker paper eqs. 1–7, as an error state (rotation error in the tangent space, body axes).
CameraState predict(const CameraState& state, Timestamp time, const MotionNoise& noise);

/// The state after its pose has been measured: the pose and its covariance become the update's, the velocities follow
/// through their correlation with it. Equal to the Kalman update, as the measurements depend on the pose alone.
CameraState absorb(const CameraState& predicted, const Eigen::Isometry3d& T_world_camera,
                   const Matrix6d& pose_covariance);

/// The noise that the last step speaks for: a running mean square of the velocity changes, so that a manoeuvre opens
/// the gate and calm closes it. `share` is the weight of this step.
MotionNoise adapt(const MotionNoise& noise, const CameraState& before, const CameraState& after, double share);

/// A state at rest at a pose, with velocities unknown by the given standard deviations (m/s, rad/s).
CameraState resting_state(Timestamp time, const Eigen::Isometry3d& T_world_camera, const Matrix6d& pose_covariance,
                          double v_sigma, double omega_sigma);

/// How the camera of a state moves: m/s and rad/s along its own axes.
Vector6d twist_of(const CameraState& state);

/// The observations as a camera that moves like `state` would have made them had all its rows been exposed at once.
std::vector<PointObservation> without_rolling_shutter(const Camera& camera, const CameraState& state,
                                                      std::vector<PointObservation> observations);

}  // namespace alidade
