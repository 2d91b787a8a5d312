// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "evaluation/statistics.h"
#include "geometry/alignment.h"

namespace alidade {

/// How far positions are from their truth once both are laid over each other.
struct PositionErrors {
  Eigen::Isometry3d T_truth_estimate = Eigen::Isometry3d::Identity();
  ErrorSeries distance_m;
};

/// Errors after the rigid alignment of paired positions (m). Empty where it is not determined (see align_points).
/// Throws std::invalid_argument for unequal lengths.
std::optional<PositionErrors> rigid_errors(std::span<const Eigen::Vector3d> estimate,
                                           std::span<const Eigen::Vector3d> truth);

}  // namespace alidade
