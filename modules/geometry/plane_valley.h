// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "geometry/plane_pose.h"

namespace alidade {

/// A pose and how far the true one may be from it, though χ² is no paraboloid: mean and covariance (right perturbation,
/// m and rad).
struct PlaneValley {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();
};

/// Where two exact poses have merged into one minimum, its information leaves a direction open, and χ² rises along it
/// with the fourth power only, in a valley that bends: mean and covariance over the valley's floor, each place by its
/// likelihood, with what the planes tell across. Weights are 1 / σ². Empty where information leaves more than one
/// direction open, or the valley goes on for half a radian (or metre).
std::optional<PlaneValley> follow_valley(std::span<const PlaneConstraint> constraints, const PlanePose& minimum);

}  // namespace alidade
