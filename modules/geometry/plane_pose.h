// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

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

struct RobustPlaneOptions {
  double gate_chi2 = 10.8;  ///< weight · distance² beyond which a plane is an outlier (1 degree of freedom, 99.9 %)
  double widest_mu = 1e12;  ///< on gate_chi2: how wide the weight may start
  int steps_per_stage = 2;  ///< of a width; the next one goes on from there
  int max_iterations = 20;  ///< of the last width, and of the settling
  int least_inliers = 6;    ///< fewer leave the pose unanswered
  double last_step = 1e-6;  ///< standard deviations; a step below it is the last
};

/// A pose and which constraints it rests on.
struct RobustPlanePose {
  PlanePose pose;               ///< from the inliers alone, and their χ²
  std::vector<bool> is_inlier;  ///< one per constraint
  int inlier_count = 0;
};

/// The pose from planes of which some are wrong, from a start: Gauss–Newton with Geman–McClure weights, whose width
/// shrinks to the gate from where a third of the planes are inside (graduated non-convexity); then least squares on
/// those within the gate, until they stay the same. Empty where fewer than least_inliers are, or where they do not
/// determine the pose. Source: Yang, Antonante, Tzoumas, Carlone, Graduated Non-Convexity, RA-L 2020.
std::optional<RobustPlanePose> solve_robustly(std::span<const PlaneConstraint> constraints,
                                              const Eigen::Isometry3d& start, const RobustPlaneOptions& options = {});

/// The minimum of the robust cost Σ c² s / (c² + s), s = weight · distance² and c² = gate_chi2, below a start: iterated
/// reweighting until a step is below last_step, without graduation.
Eigen::Isometry3d descend_robustly(std::span<const PlaneConstraint> constraints, const Eigen::Isometry3d& start,
                                   const RobustPlaneOptions& options = {});

}  // namespace alidade
