// SPDX-License-Identifier: Apache-2.0
#include "evaluation/position_error.h"

#include <utility>
#include <vector>

namespace alidade {

std::optional<PositionErrors> rigid_errors(std::span<const Eigen::Vector3d> estimate,
                                           std::span<const Eigen::Vector3d> truth) {
  const auto fit = align_points(estimate, truth, AlignmentKind::Rigid);
  if (!fit) return std::nullopt;
  std::vector<double> distances;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    distances.push_back((fit->T_target_source * estimate[i] - truth[i]).norm());
  }
  return PositionErrors{fit->T_target_source, with_statistics(std::move(distances))};
}

}  // namespace alidade
