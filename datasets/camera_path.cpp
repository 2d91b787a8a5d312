// SPDX-License-Identifier: Apache-2.0
#include "datasets/camera_path.h"

#include <cmath>
#include <numbers>

#include "view/viewpoint.h"

namespace alidade {
namespace {

Eigen::Isometry3d look(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double roll_rad) {
  Viewpoint view;
  view.eye_world = eye;
  view.target_world = target;
  view.up_world = Eigen::Vector3d::UnitZ();
  return T_world_camera_of(view) * Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ());
}

// `s`: metres walked.
Eigen::Isometry3d orbit(double s) {
  constexpr double kRadius_m = 1.65, kStart_rad = -1.9;
  const double angle = kStart_rad + s / kRadius_m;
  const double radius = kRadius_m + 0.12 * std::sin(1.7 * s), height = 1.4 + 0.16 * std::sin(1.3 * s + 0.4);
  const Eigen::Vector3d eye(radius * std::cos(angle), radius * std::sin(angle), height);
  const Eigen::Vector3d target(0.12 * std::sin(0.9 * s), 0.1 * std::sin(1.1 * s + 1.0), 0.9 + 0.06 * std::sin(1.9 * s));
  return look(eye, target, 0.09 * std::sin(1.5 * s));
}

Eigen::Isometry3d sweep(double s) {
  constexpr double kHalf_m = 1.4;
  const double phase = s / kHalf_m;
  const Eigen::Vector3d eye(-kHalf_m * std::cos(phase), -1.75 + 0.12 * std::sin(1.6 * phase),
                            1.45 + 0.15 * std::sin(2.1 * phase));
  const Eigen::Vector3d target(-0.35 * std::cos(phase) + 0.15 * std::sin(2.3 * phase), 0.6,
                               0.95 + 0.08 * std::sin(1.3 * phase));
  return look(eye, target, 0.08 * std::sin(1.8 * phase));
}

// `s`: rad turned.
Eigen::Isometry3d rotation(double s) {
  const Eigen::Vector3d eye(-0.4, -1.75, 1.4);
  const double yaw = 0.22 + 0.6 * std::sin(s / 0.6), pitch = -0.3 + 0.18 * std::sin(1.4 * s + 0.5);
  const Eigen::Vector3d ahead(std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), std::sin(pitch));
  return look(eye, eye + ahead, 0.12 * std::sin(1.1 * s));
}

// Metres walked at time t (s): goes for 1.4 s, rests for 0.8 s, without a jump in acceleration.
double stop_and_go(double speed_m_s, double t) {
  constexpr double kGo_s = 1.4, kPeriod_s = 2.2;
  const double step = speed_m_s * kGo_s;
  const double rounds = std::floor(t / kPeriod_s);
  const double u = std::min(1.0, (t - rounds * kPeriod_s) / kGo_s);
  return step * (rounds + u * u * u * (10.0 + u * (-15.0 + 6.0 * u)));
}

}  // namespace

Eigen::Isometry3d camera_on_path(PathKind kind, double speed_m_s, double time_s) {
  switch (kind) {
    case PathKind::Sweep:
      return sweep(speed_m_s * time_s);
    case PathKind::Rotation:
      return rotation(speed_m_s * time_s);
    case PathKind::StopAndGo:
      return orbit(stop_and_go(speed_m_s, time_s));
    case PathKind::Orbit:
      break;
  }
  return orbit(speed_m_s * time_s);
}

}  // namespace alidade
