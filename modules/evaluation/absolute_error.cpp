// SPDX-License-Identifier: Apache-2.0
#include "evaluation/absolute_error.h"

#include <numbers>
#include <stdexcept>
#include <utility>

namespace alidade {

AbsoluteErrors absolute_errors(const PairedTrajectories& pairs) {
  if (pairs.estimate.size() != pairs.truth.size()) throw std::invalid_argument("absolute_errors: unequal lengths");
  std::vector<double> translations, rotations;
  for (std::size_t i = 0; i < pairs.truth.size(); ++i) {
    const Eigen::Isometry3d& T_estimate = pairs.estimate[i].T_world_camera;
    const Eigen::Isometry3d& T_truth = pairs.truth[i].T_world_camera;
    translations.push_back((T_estimate.translation() - T_truth.translation()).norm());
    rotations.push_back(rotation_angle(T_truth.linear().transpose() * T_estimate.linear()) * 180.0 / std::numbers::pi);
  }
  return {with_statistics(std::move(translations)), with_statistics(std::move(rotations))};
}

}  // namespace alidade
