// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/cue.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

FinderAxes axes_of(const Receiver& receiver) {
  return receiver.camera ? FinderAxes::YDown : receiver.axes;
}

// ∂(azimuth, elevation)/∂p of a point in the receiver's axes (m): azimuth = atan2(x, z), elevation = asin(∓y / r).
Eigen::Matrix<double, 2, 3> angles_jacobian(const Vector3d& p, FinderAxes axes) {
  const double across2 = p.x() * p.x() + p.z() * p.z();
  const double across = std::sqrt(across2), range2 = p.squaredNorm();
  Eigen::Matrix<double, 2, 3> J;
  J << p.z() / across2, 0.0, -p.x() / across2,  //
      p.x() * p.y() / (range2 * across), -across / range2, p.z() * p.y() / (range2 * across);
  if (axes == FinderAxes::YUp) J.row(1) *= -1.0;
  return J;
}

Matrix3d cross_matrix(const Vector3d& p) {
  Matrix3d X;
  X << 0.0, -p.z(), p.y(), p.z(), 0.0, -p.x(), -p.y(), p.x(), 0.0;
  return X;
}

// Seconds from `told` until the receiver looks where the target of `state` is `after_s` later.
double ready_after(const SteeredReceiver& steered, const Vector3d& looks_at, const TargetState& state, Timestamp told,
                   double after_s) {
  const TargetState moved = moved_to(state, told + from_seconds(after_s));
  const Vector3d p = steered.receiver.T_world_receiver.inverse() * moved.p_world;
  const double angle = std::atan2(looks_at.cross(p).norm(), looks_at.dot(p));
  return angle / steered.slew_rad_s + steered.settle_s;
}

}  // namespace

void validate(const SteeredReceiver& steered) {
  const auto require = [](bool holds, const char* field, double value, const char* bound) {
    if (!holds) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
  };
  require(steered.slew_rad_s > 0.0, "slew_rad_s", steered.slew_rad_s, "> 0 rad/s");
  require(steered.settle_s >= 0.0, "settle_s", steered.settle_s, ">= 0 s");
}

std::optional<Cue> cue_at(const Receiver& receiver, const TargetState& state, Timestamp time,
                          const TargetMotion& motion) {
  constexpr double kOverhead = 1e-9;  // of the range: there is no azimuth
  const TargetState predicted = predict(state, time, motion);
  const Matrix3d R = receiver.T_world_receiver.linear();
  const Vector3d p = receiver.T_world_receiver.inverse() * predicted.p_world;
  if (!(std::hypot(p.x(), p.z()) > kOverhead * p.norm())) return std::nullopt;
  Matrix3d P = R.transpose() * predicted.covariance.topLeftCorner<3, 3>() * R;
  if (receiver.pose_covariance) {
    Eigen::Matrix<double, 3, 6> J_p_pose;
    J_p_pose << -Matrix3d::Identity(), cross_matrix(p);
    P += J_p_pose * *receiver.pose_covariance * J_p_pose.transpose();
  }
  const Eigen::Matrix<double, 2, 3> J = angles_jacobian(p, axes_of(receiver));
  Cue cue;
  cue.time = time;
  cue.own_time = own_time(receiver.clock, time);
  cue.azimuth_elevation = angles_of_direction(p.normalized(), axes_of(receiver));
  cue.covariance = J * P * J.transpose();
  cue.range_m = p.norm();
  return cue;
}

std::optional<Cue> cue_for(const SteeredReceiver& steered, const TargetState& state, Timestamp told,
                           const TargetMotion& motion, double most_s) {
  validate(steered);
  constexpr int kSteps = 200;
  const Vector3d looks_at =
      direction_of_angles(steered.azimuth_elevation.value_or(Vector2d::Zero()), axes_of(steered.receiver));
  const auto is_ready = [&](double after_s) { return ready_after(steered, looks_at, state, told, after_s) <= after_s; };
  int step = 0;
  while (step <= kSteps && !is_ready(most_s * step / kSteps)) ++step;
  if (step > kSteps) return std::nullopt;
  double late = most_s * step / kSteps, early = most_s * std::max(0, step - 1) / kSteps;
  constexpr int kHalvings = 40;  // to the nanosecond
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (early + late);
    (is_ready(middle) ? late : early) = middle;
  }
  return cue_at(steered.receiver, state, told + from_seconds(late), motion);
}

}  // namespace alidade
