// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/body_motion.h"

#include <cmath>

#include <Eigen/LU>

#include "geometry/rotation.h"

namespace alidade {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The turn from one knot to the next, and the rates of its rotation vector at either.
struct Turn {
  Vector3d theta, rate_before, rate_after;
  Matrix3d J_before, J_after;           // ∂theta / ∂rotation of the knots
  Matrix3d J_rate_theta, J_rate_omega;  // ∂rate_after / ∂theta, ∂omega of the knot after
};

Turn turn_between(const MotionKnot& before, const MotionKnot& after) {
  Turn turn;
  turn.theta = log_so3(before.R_world_body.transpose() * after.R_world_body);
  turn.J_after = right_jacobian_so3(turn.theta).inverse();
  turn.J_before = -right_jacobian_so3(-turn.theta).inverse();
  turn.rate_before = before.omega_body;
  turn.rate_after = turn.J_after * after.omega_body;
  turn.J_rate_omega = turn.J_after;
  turn.J_rate_theta = -0.5 * skew(after.omega_body);
  return turn;
}

}  // namespace

MotionKnot moved(const MotionKnot& knot, const Vector12d& change) {
  MotionKnot result = knot;
  result.p_world += change.segment<3>(0);
  result.R_world_body = knot.R_world_body * exp_so3(change.segment<3>(3));
  result.v_world += change.segment<3>(6);
  result.omega_body += change.segment<3>(9);
  return result;
}

MotionPose interpolate(const MotionKnot& a, const MotionKnot& b, double h, double s) {
  const double s2 = s * s, s3 = s2 * s;
  const double end = 3 * s2 - 2 * s3, start = 1 - end, start_rate = h * (s3 - 2 * s2 + s), end_rate = h * (s3 - s2);
  const Turn turn = turn_between(a, b);
  const Vector3d phi = start_rate * turn.rate_before + end * turn.theta + end_rate * turn.rate_after;
  const Matrix3d R_phi = exp_so3(phi), J_phi = right_jacobian_so3(phi), one = Matrix3d::Identity();
  const Matrix3d J_theta = J_phi * (end * one + end_rate * turn.J_rate_theta);

  MotionPose pose;
  pose.p_world = start * a.p_world + start_rate * a.v_world + end * b.p_world + end_rate * b.v_world;
  pose.R_world_body = a.R_world_body * R_phi;
  pose.J_before.setZero();
  pose.J_after.setZero();
  pose.J_before.block<3, 3>(0, 0) = start * one;
  pose.J_before.block<3, 3>(0, 6) = start_rate * one;
  pose.J_before.block<3, 3>(3, 3) = R_phi.transpose() + J_theta * turn.J_before;
  pose.J_before.block<3, 3>(3, 9) = start_rate * J_phi;
  pose.J_after.block<3, 3>(0, 0) = end * one;
  pose.J_after.block<3, 3>(0, 6) = end_rate * one;
  pose.J_after.block<3, 3>(3, 3) = J_theta * turn.J_after;
  pose.J_after.block<3, 3>(3, 9) = end_rate * J_phi * turn.J_rate_omega;
  return pose;
}

MotionConstraint constrain(const MotionKnot& a, const MotionKnot& b, double h, const MotionDensity& density) {
  const Turn turn = turn_between(a, b);
  const Matrix3d one = Matrix3d::Identity();
  // Offsets of (position, velocity) from the constant velocity have the covariance density [h³/3 h²/2; h²/2 h];
  // (√12 / h^1.5) (x - h v / 2) and v / √h are white.
  Vector12d offset;
  offset << b.p_world - a.p_world - h * a.v_world, turn.theta - h * turn.rate_before, b.v_world - a.v_world,
      turn.rate_after - turn.rate_before;
  Eigen::Matrix<double, 12, 12> J_a = Eigen::Matrix<double, 12, 12>::Zero(), J_b = J_a, W = J_a;
  J_a.block<3, 3>(0, 0) = -one;
  J_a.block<3, 3>(0, 6) = -h * one;
  J_a.block<3, 3>(3, 3) = turn.J_before;
  J_a.block<3, 3>(3, 9) = -h * one;
  J_a.block<3, 3>(6, 6) = -one;
  J_a.block<3, 3>(9, 3) = turn.J_rate_theta * turn.J_before;
  J_a.block<3, 3>(9, 9) = -one;
  J_b.block<3, 3>(0, 0) = one;
  J_b.block<3, 3>(3, 3) = turn.J_after;
  J_b.block<3, 3>(6, 6) = one;
  J_b.block<3, 3>(9, 3) = turn.J_rate_theta * turn.J_after;
  J_b.block<3, 3>(9, 9) = turn.J_rate_omega;
  for (int i = 0; i < 6; ++i) {
    const double scale = 1.0 / std::sqrt(i < 3 ? density.acceleration : density.turn);
    W(i, i) = scale * std::sqrt(12.0 / h) / h;
    W(i, i + 6) = -W(i, i) * h / 2;
    W(i + 6, i + 6) = scale / std::sqrt(h);
  }
  return {W * offset, W * J_a, W * J_b};
}

}  // namespace alidade
