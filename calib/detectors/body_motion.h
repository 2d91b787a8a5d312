// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace alidade {

/// How a body moves at one moment.
struct MotionKnot {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< of its origin, m
  Eigen::Matrix3d R_world_body = Eigen::Matrix3d::Identity();
  Eigen::Vector3d v_world = Eigen::Vector3d::Zero();     ///< m/s
  Eigen::Vector3d omega_body = Eigen::Vector3d::Zero();  ///< rad/s, along its own axes
};

/// Change of a knot: position (world), rotation (right), velocity (world), angular velocity; m, rad, m/s, rad/s.
using Vector12d = Eigen::Matrix<double, 12, 1>;
MotionKnot moved(const MotionKnot& knot, const Vector12d& change);

/// A pose between two knots, and how it moves with them: ∂(position (world), rotation (right)) / ∂(change of either).
struct MotionPose {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_world_body = Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 6, 12> J_before, J_after;
};

/// The pose at `fraction` (0 to 1) of the `interval_s` seconds from `before` to `after`: cubic Hermite, which is the
/// mean of a motion with white-noise acceleration between two known states. Rotations are interpolated in the tangent
/// space at `before`; exact where the axis is constant. The Jacobians neglect the second order of the turn from knot to
/// knot. Source: Barfoot, State Estimation for Robotics, section 11.3 (Gaussian-process motion priors).
MotionPose interpolate(const MotionKnot& before, const MotionKnot& after, double interval_s, double fraction);

/// The constraint of the motion itself: white noise on the accelerations, of `acceleration_density` (m²/s³) and
/// `turn_density` (rad²/s³). Twelve whitened residuals, of variance 1 each, and their Jacobians.
struct MotionConstraint {
  Vector12d residual;
  Eigen::Matrix<double, 12, 12> J_before, J_after;
};
struct MotionDensity {
  double acceleration = 1.0;  ///< m²/s³
  double turn = 30.0;         ///< rad²/s³
};
MotionConstraint constrain(const MotionKnot& before, const MotionKnot& after, double interval_s,
                           const MotionDensity& density);

}  // namespace alidade
