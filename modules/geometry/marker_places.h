// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/plane_constraint.h"

namespace alidade {

/// Poses that put three points of the body where three planes of each meet, at the right distances from each other up
/// to their uncertainty: hypotheses where many planes are wrong. At most `most_places` meeting points of a body's point
/// are looked at (those with most of its other planes first), and `most_poses` poses are returned, those that fit most
/// planes within `gate_chi2` (widened for the points' errors) first. Empty below three points with three planes each.
std::vector<Eigen::Isometry3d> poses_from_places(std::span<const PlaneConstraint> constraints, double gate_chi2,
                                                 int most_places, int most_poses);

}  // namespace alidade
