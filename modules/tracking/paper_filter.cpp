// SPDX-License-Identifier: Apache-2.0
#include "tracking/paper_filter.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "geometry/rotation.h"

namespace alidade {
namespace {

using Jacobian13x12 = Eigen::Matrix<double, 13, 12>;

// q is world → camera and is multiplied on the right by the turn, so the camera turns by -ω about world axes:
// ω_paper = -R_world_camera ω_camera.
Jacobian13x12 jacobian_of_paper_state(const MotionState& state) {
  const Eigen::Matrix3d R = state.T_world_body.linear();
  const Eigen::Quaterniond q(R.transpose());
  Jacobian13x12 J = Jacobian13x12::Zero();
  J.block<3, 3>(0, 0) = R;
  // R_camera_world' = exp(-θ) R_camera_world: q' = q{-θ} ⊗ q.
  J.block<1, 3>(3, 3) = 0.5 * q.vec().transpose();
  J.block<3, 3>(4, 3) = -0.5 * (q.w() * Eigen::Matrix3d::Identity() - skew(q.vec()));
  J.block<3, 3>(7, 6) = Eigen::Matrix3d::Identity();
  J.block<3, 3>(10, 3) = R * skew(state.omega_body);
  J.block<3, 3>(10, 9) = -R;
  return J;
}

Eigen::Quaterniond quaternion_of(const Vector13d& s) {
  return {s(3), s(4), s(5), s(6)};
}

// ∂(R(q) a)/∂q for R(q) a = (w² - |u|²) a + 2 (u·a) u + 2 w (u × a), columns w, x, y, z.
Eigen::Matrix<double, 3, 4> jacobian_of_rotated(const Eigen::Quaterniond& q, const Eigen::Vector3d& a) {
  const Eigen::Vector3d u = q.vec();
  Eigen::Matrix<double, 3, 4> J;
  J.col(0) = 2.0 * (q.w() * a + u.cross(a));
  J.rightCols<3>() =
      2.0 * (u.dot(a) * Eigen::Matrix3d::Identity() + u * a.transpose() - a * u.transpose() - q.w() * skew(a));
  return J;
}

}  // namespace

PaperState to_paper_state(const MotionState& state) {
  const Eigen::Matrix3d R = state.T_world_body.linear();
  const Eigen::Quaterniond q(R.transpose());
  PaperState paper;
  paper.s << state.T_world_body.translation(), q.w(), q.x(), q.y(), q.z(), state.v_world, -R * state.omega_body;
  const Jacobian13x12 J = jacobian_of_paper_state(state);
  paper.P = J * state.covariance.topLeftCorner<12, 12>() * J.transpose();
  return paper;
}

MotionState from_paper_state(const PaperState& paper, Timestamp time) {
  MotionState state;
  state.time = time;
  const Eigen::Matrix3d R = quaternion_of(paper.s).normalized().toRotationMatrix().transpose();
  state.T_world_body.linear() = R;
  state.T_world_body.translation() = paper.s.head<3>();
  state.v_world = paper.s.segment<3>(7);
  state.omega_body = -R.transpose() * paper.s.tail<3>();
  // The 13×12 Jacobian has full column rank: its pseudo-inverse drops the length of q and inverts the rest.
  const Jacobian13x12 J = jacobian_of_paper_state(state);
  const Eigen::Matrix<double, 12, 13> J_inverse = (J.transpose() * J).ldlt().solve(J.transpose());
  state.covariance.setZero();
  state.covariance.topLeftCorner<12, 12>() = J_inverse * paper.P * J_inverse.transpose();
  return state;
}

Eigen::Matrix<double, 2, 13> paper_measurement_jacobian(const Camera& camera, const Vector13d& s,
                                                        const Eigen::Vector3d& p_world) {
  Eigen::Matrix<double, 2, 13> H = Eigen::Matrix<double, 2, 13>::Zero();
  const Eigen::Quaterniond q = quaternion_of(s);
  const Eigen::Vector3d a = p_world - s.head<3>();
  const auto projection = project(camera, q.toRotationMatrix() * a);
  if (!projection) return H;
  H.leftCols<3>() = -projection->J_pixel_point * q.toRotationMatrix();
  H.block<2, 4>(0, 3) = projection->J_pixel_point * jacobian_of_rotated(q, a);
  return H;
}

MotionState update_paper_filter(const Camera& camera, const MotionState& predicted,
                                std::span<const PointObservation> observations) {
  PaperState paper = to_paper_state(predicted);
  const Eigen::Matrix3d R_camera_world = quaternion_of(paper.s).toRotationMatrix();
  Matrix13d information = Matrix13d::Zero();
  Vector13d innovation = Vector13d::Zero();
  for (const PointObservation& o : observations) {
    const auto projection = project(camera, R_camera_world * (o.p_world - paper.s.head<3>()));
    if (!projection) continue;
    const Eigen::Matrix<double, 2, 13> H = paper_measurement_jacobian(camera, paper.s, o.p_world) / o.sigma_px;
    information += H.transpose() * H;
    innovation += H.transpose() * (o.pixel - projection->pixel) / o.sigma_px;
  }
  const Matrix13d shrink = (Matrix13d::Identity() + paper.P * information).inverse();
  paper.s += shrink * paper.P * innovation;
  paper.P = shrink * paper.P;
  paper.s.segment<4>(3).normalize();
  return from_paper_state(paper, predicted.time);
}

}  // namespace alidade
