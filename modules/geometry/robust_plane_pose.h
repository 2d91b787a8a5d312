// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/plane_pose.h"

namespace alidade {

struct RobustPlaneOptions {
  double gate_chi2 = 10.8;  ///< weight · distance² beyond which a plane is an outlier (1 degree of freedom, 99.9 %)
  double widest_mu = 1e12;  ///< on gate_chi2: how wide the weight may start
  int steps_per_stage = 1;  ///< of a width; the next one goes on from there
  int max_iterations = 20;  ///< of the last width, and of the settling
  int least_inliers = 6;    ///< fewer leave the pose unanswered
};

/// A pose and which constraints it rests on.
struct RobustPlanePose {
  PlanePose pose;               ///< from the inliers alone, and their χ²
  std::vector<bool> is_inlier;  ///< one per constraint
  int inlier_count = 0;
};

/// The pose from planes of which some are wrong, from a start: Gauss–Newton with Geman–McClure weights, whose width
/// shrinks to the gate from where half of the planes are well inside (graduated non-convexity); then least squares on
/// those within the gate, until they stay the same. Empty where fewer than least_inliers are, or where they do not
/// determine the pose. Keep constraints of one point together (see sum_planes). Source: Yang, Antonante, Tzoumas,
/// Carlone, Graduated Non-Convexity, RA-L 2020.
std::optional<RobustPlanePose> solve_robustly(std::span<const PlaneConstraint> constraints,
                                              const Eigen::Isometry3d& start, const RobustPlaneOptions& options = {});

/// Where the first half of solve_robustly ends: a minimum of Σ c² s / (c² + s), s = weight · distance², c² = gate_chi2,
/// but for a step shorter than `last_step` standard deviations, of which a fiftieth is left undone.
Eigen::Isometry3d descend_robustly(std::span<const PlaneConstraint> constraints, const Eigen::Isometry3d& start,
                                   const RobustPlaneOptions& options = {}, double last_step = 0.3);

}  // namespace alidade
