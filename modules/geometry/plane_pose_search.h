// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "geometry/plane_pose_minima.h"
#include "geometry/robust_plane_pose.h"

namespace alidade {

struct PlaneSearchOptions {
  RobustPlaneOptions robust{.steps_per_stage = 2};  ///< gate, and how each hypothesis is settled
  int starts = 32;                                  ///< rotations spread over SO(3), from which is solved robustly
  int most_points = 64;       ///< places of one marker, from three of its planes each, that are tried
  int most_hypotheses = 16;   ///< poses from places of three markers that are solved robustly
  double margin_chi2 = 50.0;  ///< of robust χ² (each plane's at most the gate), by which the best must beat all others
  int least_inliers = 10;     ///< of a certain pose: six planes fit anything
  double least_share = 0.4;   ///< of planes that fit a certain pose
  PlaneJudgementOptions judgement;  ///< of the inliers alone
};

/// What a search found: poses that are apart, the best first, by robust χ² = Σ min(weight · distance², gate).
struct PlaneSearch {
  PlaneVerdict verdict = PlaneVerdict::Undetermined;
  std::vector<RobustPlanePose> candidates;  ///< one if Certain; of others all within the margin
};

/// The pose without a start from planes of which up to 45 % are wrong (of another marker, say). Hypotheses: robust
/// solutions from rotations spread evenly, and poses from places of three markers, each where three of its planes meet,
/// at the right distances from each other. Certain only where one pose beats all others that were found by the margin,
/// enough planes fit it, and these tell the pose by themselves (judge_minima). About 1 ms for 32 planes of 4 markers.
/// Keep constraints of one point together. Throws as all_minima.
PlaneSearch search_pose(std::span<const PlaneConstraint> constraints, const PlaneSearchOptions& options = {});

}  // namespace alidade
