// SPDX-License-Identifier: Apache-2.0
#include "estimation/motion_state.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "geometry/rotation.h"

namespace alidade {
namespace {

// The rotation vector of a step.
Eigen::Vector3d turn_of(const MotionState& state, double dt) {
  return dt * state.omega_body + 0.5 * dt * dt * state.alpha_body;
}

// F as its blocks, most of which are zero or multiples of one.
struct Transition {
  double dt;
  Eigen::Matrix3d R_next_world;
  Eigen::Matrix3d turned_back;  // R_next_now
  Eigen::Matrix3d J_turn;

  // F times the columns of M, which are errors of a state.
  template <int Columns>
  Eigen::Matrix<double, 18, Columns> operator*(const Eigen::Matrix<double, 18, Columns>& M) const {
    const auto rows = [&M](int first) { return M.template middleRows<3>(first); };
    Eigen::Matrix<double, 18, Columns> FM = M;
    // The translation error is counted along the camera's own axes, which have turned by the new pose.
    FM.template middleRows<3>(0) = turned_back * rows(0) + R_next_world * (dt * rows(6) + 0.5 * dt * dt * rows(12));
    FM.template middleRows<3>(3) = turned_back * rows(3) + J_turn * (dt * rows(9) + 0.5 * dt * dt * rows(15));
    FM.template middleRows<6>(6) += dt * M.template middleRows<6>(12);
    return FM;
  }
};

Transition transition(const MotionState& state, const MotionState& predicted) {
  const double dt = to_seconds(predicted.time - state.time);
  const Eigen::Matrix3d R_next_world = predicted.T_world_body.linear().transpose();
  return {dt, R_next_world, R_next_world * state.T_world_body.linear(), right_jacobian_so3(turn_of(state, dt))};
}

// G Q Gᵀ, where the noise moves pose, velocities and accelerations by G's three blocks.
Matrix18d spread(const std::array<Matrix6d, 3>& G, const Matrix6d& Q) {
  Matrix18d spread;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      spread.block<6, 6>(6 * row, 6 * column) = G[row] * Q * G[column].transpose();
    }
  }
  return spread;
}

// How the pose that is measured in a map moves with the map's offset: a map displaced one way shows the camera
// displaced the other.
Matrix6d jacobian_of_offset(const MotionState& state) {
  const Eigen::Matrix3d R_camera_world = state.T_world_body.linear().transpose();
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = -R_camera_world;
  J.topRightCorner<3, 3>() = R_camera_world * skew(state.T_world_body.translation() - state.map_offset.centre_world);
  J.bottomRightCorner<3, 3>() = -R_camera_world;
  return J;
}

}  // namespace

MotionState moved_by(MotionState state, const Vector18d& error) {
  state.T_world_body = state.T_world_body * perturbation(error.head<6>());
  state.v_world += error.segment<3>(6);
  state.omega_body += error.segment<3>(9);
  state.a_world += error.segment<3>(12);
  state.alpha_body += error.segment<3>(15);
  return state;
}

Vector18d error_between(const MotionState& from, const MotionState& to) {
  Vector18d error;
  error << difference(from.T_world_body, to.T_world_body), to.v_world - from.v_world, to.omega_body - from.omega_body,
      to.a_world - from.a_world, to.alpha_body - from.alpha_body;
  return error;
}

MotionState predict(const MotionState& state, Timestamp time, const MotionNoise& noise) {
  MotionState next = predict_without_noise(state, time);
  next.covariance += noise_covariance(state, next, noise);
  return next;
}

MotionState predict_without_noise(const MotionState& state, Timestamp time) {
  const double dt = std::max(0.0, to_seconds(time - state.time));
  MotionState next = state;
  next.time = std::max(time, state.time);
  next.T_world_body.translation() += dt * state.v_world + 0.5 * dt * dt * state.a_world;
  const Eigen::Matrix3d turn = exp_so3(turn_of(state, dt));
  next.T_world_body.linear() = state.T_world_body.linear() * turn;
  next.v_world += dt * state.a_world;
  next.omega_body += dt * state.alpha_body;

  const Transition F = transition(state, next);
  next.covariance = F * Matrix18d((F * state.covariance).transpose());  // F P Fᵀ: P is symmetric
  next.map_offset.cross = F * state.map_offset.cross;
  return next;
}

Matrix18d noise_covariance(const MotionState& state, const MotionState& predicted, const MotionNoise& noise) {
  const double dt = to_seconds(predicted.time - state.time);
  // What the noise does to the pose, in its own axes.
  const Transition F = transition(state, predicted);
  Matrix6d to_pose = Matrix6d::Zero();
  to_pose.topLeftCorner<3, 3>() = F.R_next_world;
  to_pose.bottomRightCorner<3, 3>() = F.J_turn;
  const Matrix6d I = Matrix6d::Identity();
  Matrix18d Q = Matrix18d::Zero();
  if (!noise.acceleration.isZero(0.0)) {  // eqs. 5, 6: V = aΔt, Ω = αΔt
    Q += spread({dt * dt * to_pose, dt * I, 0.0 * I}, noise.acceleration);
  }
  if (!noise.jerk.isZero(0.0)) Q += spread({dt * dt * dt / 6.0 * to_pose, 0.5 * dt * dt * I, dt * I}, noise.jerk);
  if (!noise.jump.isZero(0.0)) Q += spread({0.5 * dt * dt * to_pose, dt * I, I}, noise.jump);
  return Q;
}

Matrix18d transition_jacobian(const MotionState& state, const MotionState& predicted) {
  return transition(state, predicted) * Matrix18d(Matrix18d::Identity());
}

MotionState absorb(const MotionState& predicted, const PoseLikelihood& sightings) {
  const PoseLikelihood z = about(predicted.T_world_body, sightings);
  const MapOffset& offset = predicted.map_offset;
  const Matrix6d of_offset = jacobian_of_offset(predicted);
  // Covariances with the pose in the map: of all of the state, of the pose in the map itself and of the offset.
  const Matrix18x6 C = predicted.covariance.leftCols<6>() + offset.cross * of_offset.transpose();
  const Matrix6d C_map =
      C.topRows<6>() + of_offset * (offset.cross.topRows<6>().transpose() + offset.covariance * of_offset.transpose());
  const Matrix6d C_offset = offset.cross.topRows<6>().transpose() + offset.covariance * of_offset.transpose();
  const Matrix18x6 gain = C * (Matrix6d::Identity() + z.information * C_map).inverse();  // of the gradient
  const Matrix18x6 K = gain * z.information;                                             // of the pose in the map
  const Vector18d error = gain * z.gradient;

  MotionState state = moved_by(predicted, error);
  // Joseph's form of P - K Cᵀ: (I - K H) P (I - K H)ᵀ + K R Kᵀ over state and offset, whose own gain is zero.
  const Matrix18d K_C = K * C.transpose();
  const Matrix18x6 from_map = K * C_map + gain;
  state.covariance = predicted.covariance - K_C - K_C.transpose() + K * from_map.transpose();
  state.map_offset.cross = offset.cross - K * C_offset.transpose();
  // The error is counted from the new pose, along its axes.
  Matrix6d reset = Matrix6d::Zero();
  reset.topLeftCorner<3, 3>() = exp_so3(error.segment<3>(3)).transpose();
  reset.bottomRightCorner<3, 3>() = right_jacobian_so3(error.segment<3>(3));
  state.covariance.topRows<6>() = (reset * state.covariance.topRows<6>()).eval();
  state.covariance.leftCols<6>() = (state.covariance.leftCols<6>() * reset.transpose()).eval();
  state.covariance = 0.5 * (state.covariance + state.covariance.transpose()).eval();
  state.map_offset.cross.topRows<6>() = (reset * state.map_offset.cross.topRows<6>()).eval();
  return state;
}

MotionState absorb(const MotionState& predicted, const Eigen::Isometry3d& T_world_body,
                   const Matrix6d& pose_covariance) {
  const Vector6d xi = difference(predicted.T_world_body, T_world_body);
  const Matrix6d P = predicted.covariance.topLeftCorner<6, 6>();
  // How all of the state follows the pose: P_{:,pose} P_pose⁻¹.
  const Matrix18x6 follow = P.ldlt().solve(predicted.covariance.topRows<6>()).transpose();
  MotionState state = moved_by(predicted, follow * xi);
  state.T_world_body = T_world_body;
  state.covariance = predicted.covariance + follow * (pose_covariance - P) * follow.transpose();
  state.covariance = 0.5 * (state.covariance + state.covariance.transpose()).eval();
  return state;
}

Matrix6d covariance_in_map(const MotionState& state) {
  const Matrix6d J = jacobian_of_offset(state);
  const Matrix6d shared = state.map_offset.cross.topRows<6>() * J.transpose();
  return state.covariance.topLeftCorner<6, 6>() + shared + shared.transpose() +
         J * state.map_offset.covariance * J.transpose();
}

double log_evidence(const MotionState& predicted, const PoseLikelihood& sightings) {
  return log_evidence(covariance_in_map(predicted), about(predicted.T_world_body, sightings));
}

double log_evidence(const Matrix6d& covariance_in_map, const PoseLikelihood& sightings_about_prediction) {
  const PoseLikelihood& z = sightings_about_prediction;
  const Eigen::PartialPivLU<Matrix6d> M(Matrix6d::Identity() + covariance_in_map * z.information);
  // The sightings' own optimum takes its part out, so that only the distance to the prediction counts.
  const double fit = z.gradient.dot(M.solve(covariance_in_map * z.gradient));
  const double best = z.gradient.dot(z.information.ldlt().solve(z.gradient));
  return 0.5 * (fit - best) - 0.5 * std::log(M.determinant());
}

PoseLikelihood about(const Eigen::Isometry3d& T_world_body, const PoseLikelihood& likelihood) {
  const Vector6d off = difference(T_world_body, likelihood.T_world_body);
  Matrix6d J = Matrix6d::Zero();  // ∂(perturbation of likelihood.T_world_body)/∂(perturbation of T_world_body)
  J.topLeftCorner<3, 3>() = likelihood.T_world_body.linear().transpose() * T_world_body.linear();
  J.bottomRightCorner<3, 3>() = right_jacobian_so3(off.tail<3>());
  PoseLikelihood moved;
  moved.T_world_body = T_world_body;
  moved.information = J.transpose() * likelihood.information * J;
  moved.gradient = J.transpose() * likelihood.gradient + moved.information * off;
  return moved;
}

MotionNoise adapt(const MotionNoise& noise, const MotionState& before, const MotionState& after, double share) {
  const double dt = to_seconds(after.time - before.time);
  if (!(dt > 0)) return noise;
  const auto blend = [share](double variance, double change_squared) {
    return std::max((1.0 - share) * variance + share * change_squared, 1e-4 * variance);
  };
  // A third of the squared norm is the variance per axis; twice that keeps the prior on the loose side.
  const double a2 = (after.v_world - before.v_world).squaredNorm() / (dt * dt) * 2.0 / 3.0;
  const double alpha2 = (after.omega_body - before.omega_body).squaredNorm() / (dt * dt) * 2.0 / 3.0;
  const Vector6d now = noise.acceleration.diagonal();
  MotionNoise next = noise;
  next.acceleration = isotropic_noise(std::sqrt(blend(now(0), a2)), std::sqrt(blend(now(3), alpha2)));
  return next;
}

MotionState resting_state(Timestamp time, const Eigen::Isometry3d& T_world_body, const Matrix6d& pose_covariance,
                          double v_sigma, double omega_sigma) {
  MotionState state;
  state.time = time;
  state.T_world_body = T_world_body;
  state.covariance.setZero();
  state.covariance.topLeftCorner<6, 6>() = pose_covariance;
  state.covariance.block<3, 3>(6, 6) = v_sigma * v_sigma * Eigen::Matrix3d::Identity();
  state.covariance.block<3, 3>(9, 9) = omega_sigma * omega_sigma * Eigen::Matrix3d::Identity();
  return state;
}

MotionState moving_state(const StampedPose& first, const StampedPose& second) {
  const double dt = std::max(1e-6, to_seconds(second.time - first.time));
  const Vector6d motion = difference(first.T_world_camera, second.T_world_camera);
  const double v = motion.head<3>().norm() / dt, omega = motion.tail<3>().norm() / dt;
  MotionState state = resting_state(second.time, second.T_world_camera,
                                    second.covariance.value_or(Matrix6d::Zero()) + 1e-12 * Matrix6d::Identity(), 0, 0);
  state.v_world = (second.T_world_camera.translation() - first.T_world_camera.translation()) / dt;
  state.omega_body = motion.tail<3>() / dt;
  const Matrix6d A = isotropic_noise(v / dt, omega / dt);
  state.covariance.block<6, 6>(12, 12) = A;
  state.covariance.block<6, 6>(6, 12) = state.covariance.block<6, 6>(12, 6) = 0.5 * dt * A;
  state.covariance.block<6, 6>(6, 6) = 0.25 * dt * dt * A + isotropic_noise(0.05 * v, 0.05 * omega);
  return state;
}

Vector6d twist_of(const MotionState& state) {
  Vector6d twist;
  twist << state.T_world_body.linear().transpose() * state.v_world, state.omega_body;
  return twist;
}

}  // namespace alidade
