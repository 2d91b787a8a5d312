// SPDX-License-Identifier: Apache-2.0
#include "evaluation/path_error.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace alidade {

Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& R) {
  constexpr double kLock = 1e-12;
  const double cosine = std::hypot(R(0, 0), R(1, 0));
  const double pitch = std::atan2(-R(2, 0), cosine);
  if (cosine < kLock) return {0.0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

PathErrors path_errors(const PairedTrajectories& pairs) {
  if (pairs.estimate.size() != pairs.truth.size()) throw std::invalid_argument("path_errors: unequal lengths");
  PathErrors errors;
  errors.path_length_m = path_length(pairs.truth);
  const double percent = errors.path_length_m > 0 ? 100.0 / errors.path_length_m : 0.0;
  std::vector<double> translations, rotations;
  for (std::size_t i = 0; i < pairs.truth.size(); ++i) {
    const Eigen::Isometry3d& T_estimate = pairs.estimate[i].T_world_camera;
    const Eigen::Isometry3d& T_truth = pairs.truth[i].T_world_camera;
    translations.push_back(percent * (T_estimate.translation() - T_truth.translation()).norm());
    const Eigen::Vector3d turn = roll_pitch_yaw(T_estimate.linear()) - roll_pitch_yaw(T_truth.linear());
    const auto short_way = [](double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); };
    rotations.push_back(turn.unaryExpr(short_way).norm() * 180.0 / std::numbers::pi);
  }
  errors.translation_percent = with_statistics(std::move(translations));
  errors.rotation_deg = with_statistics(std::move(rotations));
  return errors;
}

}  // namespace alidade
