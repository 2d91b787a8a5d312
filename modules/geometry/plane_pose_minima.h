// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "geometry/plane_pose.h"

namespace alidade {

struct PlaneMinimaOptions {
  int starts = 120;  ///< rotations spread evenly over SO(3), from which is descended; 60 miss one of six in a thousand
  double same_rotation_rad = 1e-4;  ///< two minima nearer than this are one
};

/// All poses that are local minima of Σ weight · distance², the best first: from points and planes alone, without a
/// start. Six or more planes that determine the pose have few minima (of six planes up to eight are exact). Planes do
/// not know front from back: a camera's pose may have points behind it, and one from points in a plane has a twin
/// behind; callers that know on which side points are drop those. Where the planes leave directions open, one of the
/// many poses that are equally good is returned, with its rank-deficient information. Empty without constraints.
/// Throws std::invalid_argument for a normal that is not of unit length or a weight that is not positive.
std::vector<PlanePose> all_minima(std::span<const PlaneConstraint> constraints, const PlaneMinimaOptions& options = {});

/// How surely minima of one set of constraints tell the pose.
enum class PlaneVerdict {
  Certain,       ///< one minimum explains the planes, and it is a sharp one
  Ambiguous,     ///< several do, or the one is so blunt that its information misstates how far the truth may be
  Undetermined,  ///< the planes leave a direction open
  Unexplained,   ///< no minimum explains the planes within their noise: some of them are wrong
};

struct PlaneJudgement {
  PlaneVerdict verdict = PlaneVerdict::Undetermined;
  std::vector<PlanePose> candidates;  ///< all that may be the pose, the best first; one if Certain
};

struct PlaneJudgementOptions {
  /// χ² above the best minimum's up to which another one may be the pose. A wrong minimum undercuts the true pose by
  /// Δ with probability Φ(-√Δ) at most: 1e-9 for 36.
  double margin_chi2 = 36.0;
  double most_sigmas = 5.0;     ///< by which the best χ² may exceed what its degrees of freedom promise
  double bluntest_rad = 0.025;  ///< standard deviation of a rotation beyond which its linearisation is not trusted
  double least_rise = 0.75;     ///< of χ² where it should have risen by the margin, as a share of it
};

/// Judges minima (all of them, or those that the caller has left) of constraints whose weights are true: 1 / σ².
PlaneJudgement judge_minima(std::span<const PlaneConstraint> constraints, std::span<const PlanePose> minima,
                            const PlaneJudgementOptions& options = {});

}  // namespace alidade
