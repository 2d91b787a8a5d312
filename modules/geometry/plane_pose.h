// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/plane_constraint.h"
#include "geometry/plane_sums.h"
#include "geometry/pose.h"

namespace alidade {

// A rigid transform from planes: the pose of a body whose points lie in planes of the world. It is the pose of a body
// with markers seen by linear detectors, and of a camera among known points (the camera's frame is then the world).

/// A pose in which points are near their planes.
struct PlanePose {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  double chi2 = 0.0;                        ///< Σ weight · distance²
  Matrix6d information = Matrix6d::Zero();  ///< of the right perturbation, m and rad; its rank tells what is determined
};

/// How many of the six directions of a pose an information matrix tells: eigenvalues, with each row and column scaled
/// to a unit diagonal, above `least_share`. 6: the pose is determined. Two markers, however many planes: 5.
int determined_directions(const Matrix6d& information, double least_share = 1e-9);

/// χ² and information at a pose.
PlanePose plane_pose_at(std::span<const PlaneConstraint> constraints, const Eigen::Isometry3d& T_world_body);

/// The least-squares pose from sums over planes and a start near it (rotation only; an extrapolated one needs two or
/// three Newton steps). Empty where newton_rotation is, and where the planes leave translation open.
std::optional<Eigen::Isometry3d> newton_pose(const PlaneSums& sums, const Eigen::Isometry3d& start);

}  // namespace alidade
