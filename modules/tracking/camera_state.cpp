// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_state.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "camera/rolling_shutter.h"
#include "geometry/rotation.h"

namespace alidade {

CameraState predict(const CameraState& state, Timestamp time, const MotionNoise& noise) {
  const double dt = std::max(0.0, to_seconds(time - state.time));
  CameraState next = state;
  next.time = time;
  next.T_world_camera.translation() += state.v_world * dt;
  const Eigen::Matrix3d turn = exp_so3(state.omega_camera * dt);
  next.T_world_camera.linear() = state.T_world_camera.linear() * turn;

  // The translation error is counted along the camera's own axes, which have turned by the new pose.
  const Eigen::Matrix3d R_next_world = next.T_world_camera.linear().transpose();
  Matrix12d F = Matrix12d::Identity();
  F.block<3, 3>(0, 0) = turn.transpose();
  F.block<3, 3>(0, 6) = dt * R_next_world;
  F.block<3, 3>(3, 3) = turn.transpose();
  const Eigen::Matrix3d J_turn = dt * right_jacobian_so3(state.omega_camera * dt);
  F.block<3, 3>(3, 9) = J_turn;

  Eigen::Matrix<double, 12, 6> G = Eigen::Matrix<double, 12, 6>::Zero();  // eqs. 5, 6: V = aΔt, Ω = αΔt
  G.block<3, 3>(0, 0) = dt * dt * R_next_world;
  G.block<3, 3>(6, 0) = dt * Eigen::Matrix3d::Identity();
  G.block<3, 3>(3, 3) = dt * J_turn;
  G.block<3, 3>(9, 3) = dt * Eigen::Matrix3d::Identity();
  Vector6d q;
  q << Eigen::Vector3d::Constant(noise.acceleration * noise.acceleration),
      Eigen::Vector3d::Constant(noise.angular_acceleration * noise.angular_acceleration);
  next.covariance = F * state.covariance * F.transpose() + G * q.asDiagonal() * G.transpose();
  return next;
}

CameraState absorb(const CameraState& predicted, const Eigen::Isometry3d& T_world_camera,
                   const Matrix6d& pose_covariance) {
  CameraState state = predicted;
  const Vector6d xi = difference(predicted.T_world_camera, T_world_camera);
  const Matrix6d P = predicted.covariance.topLeftCorner<6, 6>();
  // How all of the state follows the pose: P_{:,pose} P_pose⁻¹.
  const Eigen::Matrix<double, 12, 6> follow = P.ldlt().solve(predicted.covariance.topRows<6>()).transpose();
  const Eigen::Matrix<double, 6, 1> velocity = follow.bottomRows<6>() * xi;
  state.T_world_camera = T_world_camera;
  state.v_world += velocity.head<3>();
  state.omega_camera += velocity.tail<3>();
  state.covariance = predicted.covariance + follow * (pose_covariance - P) * follow.transpose();
  state.covariance = 0.5 * (state.covariance + state.covariance.transpose()).eval();
  return state;
}

MotionNoise adapt(const MotionNoise& noise, const CameraState& before, const CameraState& after, double share) {
  const double dt = to_seconds(after.time - before.time);
  if (!(dt > 0)) return noise;
  const auto blend = [share](double sigma, double change_squared) {
    const double next = (1.0 - share) * sigma * sigma + share * change_squared;
    return std::sqrt(std::max(next, 1e-4 * sigma * sigma));
  };
  // A third of the squared norm is the variance per axis; twice that keeps the prior on the loose side.
  const double a2 = (after.v_world - before.v_world).squaredNorm() / (dt * dt) * 2.0 / 3.0;
  const double alpha2 = (after.omega_camera - before.omega_camera).squaredNorm() / (dt * dt) * 2.0 / 3.0;
  return {blend(noise.acceleration, a2), blend(noise.angular_acceleration, alpha2)};
}

CameraState resting_state(Timestamp time, const Eigen::Isometry3d& T_world_camera, const Matrix6d& pose_covariance,
                          double v_sigma, double omega_sigma) {
  CameraState state;
  state.time = time;
  state.T_world_camera = T_world_camera;
  state.covariance.setZero();
  state.covariance.topLeftCorner<6, 6>() = pose_covariance;
  state.covariance.block<3, 3>(6, 6) = v_sigma * v_sigma * Eigen::Matrix3d::Identity();
  state.covariance.block<3, 3>(9, 9) = omega_sigma * omega_sigma * Eigen::Matrix3d::Identity();
  return state;
}

Vector6d twist_of(const CameraState& state) {
  Vector6d twist;
  twist << state.T_world_camera.linear().transpose() * state.v_world, state.omega_camera;
  return twist;
}

std::vector<PointObservation> without_rolling_shutter(const Camera& camera, const CameraState& state,
                                                      std::vector<PointObservation> observations) {
  const Eigen::Isometry3d T_camera_world = state.T_world_camera.inverse();
  for (PointObservation& o : observations) {
    const double depth_m = (T_camera_world * o.p_world).z();
    if (depth_m > 0) o.pixel = at_middle_row(camera, o.pixel, twist_of(state), depth_m);
  }
  return observations;
}

}  // namespace alidade
