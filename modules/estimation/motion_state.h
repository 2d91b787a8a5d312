// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/time.h"
#include "estimation/motion_noise.h"
#include "estimation/pose_update.h"
#include "geometry/pose.h"
#include "geometry/trajectory.h"

namespace alidade {

using Vector18d = Eigen::Matrix<double, 18, 1>;
using Matrix18d = Eigen::Matrix<double, 18, 18>;
using Matrix18x6 = Eigen::Matrix<double, 18, 6>;

/// What the sightings of one map have in common: the map lies displaced as a rigid body, by a vector and a rotation
/// vector about `centre`. It is never estimated, only considered (Schmidt 1966): the state knows how it depends on it.
struct MapOffset {
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  Matrix6d covariance = Matrix6d::Zero();  ///< m and rad, world axes; zero: there is none
  Matrix18x6 cross = Matrix18x6::Zero();   ///< covariance of the state's error with it
};

/// The filter's state: where a body (or camera) is and how it moves. The map is not part of it. Where the accelerations
/// are known to be zero (no covariance, no jerk), it is the paper's constant velocity.
struct MotionState {
  Timestamp time{};
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d v_world = Eigen::Vector3d::Zero();     ///< m/s
  Eigen::Vector3d omega_body = Eigen::Vector3d::Zero();  ///< rad/s, body axes
  Eigen::Vector3d a_world = Eigen::Vector3d::Zero();     ///< m/s²
  Eigen::Vector3d alpha_body = Eigen::Vector3d::Zero();  ///< rad/s², body axes
  /// Of the error (xi of the pose: translation and rotation in body axes; v_world; omega_body; a_world;
  /// alpha_body); m, rad, s.
  Matrix18d covariance = Matrix18d::Identity();
  MapOffset map_offset;
};

/// The state moved by an error as MotionState::covariance counts it, and the error that moves `from` to `to`.
MotionState moved_by(MotionState state, const Vector18d& error);
Vector18d error_between(const MotionState& from, const MotionState& to);

/// Where the body will be at `time`: constant acceleration, with what changes it as noise. A time before the state's
/// is taken as the state's own.
/// Source: camera-tracker paper eqs. 1–7, as an error state (rotation error in the tangent space, body axes), with
/// accelerations.
MotionState predict(const MotionState& state, Timestamp time, const MotionNoise& noise);

/// predict() without noise, and what noise adds to its covariance.
MotionState predict_without_noise(const MotionState& state, Timestamp time);
Matrix18d noise_covariance(const MotionState& state, const MotionState& predicted, const MotionNoise& noise);

/// F of the step to `predicted`: how an error of `state` carries over, ∂error(predicted)/∂error(state).
Matrix18d transition_jacobian(const MotionState& state, const MotionState& predicted);

/// The state after the sightings of a frame: the Kalman update, in information form about the pose and Joseph form for
/// the covariance, with the map's offset considered. The sightings may determine the pose in part only.
MotionState absorb(const MotionState& predicted, const PoseLikelihood& sightings);

/// The same where only the outcome is known: the pose and its covariance become those given, all else follows through
/// its correlation with the pose.
MotionState absorb(const MotionState& predicted, const Eigen::Isometry3d& T_world_body,
                   const Matrix6d& pose_covariance);

/// What a frame's sightings are expected to measure: the pose in the map as the map lies, P_pose and the map's offset.
/// 6×6, of the right perturbation.
Matrix6d covariance_in_map(const MotionState& state);

/// The log of the probability density that the prediction gives to the sightings, up to a constant that depends on the
/// sightings alone: the innovation likelihood.
double log_evidence(const MotionState& predicted, const PoseLikelihood& sightings);

/// The same from the prediction's covariance_in_map and the sightings' likelihood about its pose.
double log_evidence(const Matrix6d& covariance_in_map, const PoseLikelihood& sightings_about_prediction);

/// The same likelihood as a function of the perturbation of another pose.
PoseLikelihood about(const Eigen::Isometry3d& T_world_body, const PoseLikelihood& likelihood);

/// The noise that the last step speaks for: a running mean square of the velocity changes, so that a manoeuvre opens
/// the gate and calm closes it. `share` is the weight of this step; the noise stays alike along all axes.
MotionNoise adapt(const MotionNoise& noise, const MotionState& before, const MotionState& after, double share);

/// A state at rest at a pose, with velocities unknown by the given standard deviations (m/s, rad/s) and without
/// acceleration.
MotionState resting_state(Timestamp time, const Eigen::Isometry3d& T_world_body, const Matrix6d& pose_covariance,
                          double v_sigma, double omega_sigma);

/// The state at the second of two poses, at the pace between them. The body
/// may just have set off: v = Δp / Δt + a Δt / 2 with an acceleration of up to v / Δt, and likewise in rotation.
MotionState moving_state(const StampedPose& first, const StampedPose& second);

/// How the body of a state moves: m/s and rad/s along its own axes.
Vector6d twist_of(const MotionState& state);

}  // namespace alidade
