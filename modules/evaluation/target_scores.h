// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "evaluation/error_consistency.h"
#include "evaluation/gospa.h"
#include "evaluation/track_identity.h"

namespace alidade {

/// How well many targets were followed.
struct TargetScores {
  std::size_t moments = 0;
  std::size_t pairs = 0;         ///< estimates with a target within the cutoff
  double rms_m = 0.0;            ///< of their distances; 0 where there are none
  double median_m = 0.0;         ///< likewise
  double gospa_m = 0.0;          ///< mean over the moments
  double ospa_m = 0.0;           ///< likewise
  double localisation_m2 = 0.0;  ///< mean parts of GOSPA to the power of 2
  double missed_m2 = 0.0, false_m2 = 0.0;
  double count_right = 0.0;  ///< share of the moments with as many estimates as targets
  TrackIdentity identity;
  ErrorConsistency nees;  ///< of the pairs' positions; of those with a covariance
};

/// Moments in order of time; an estimate farther than `cutoff_m` from every target is a false one. Throws
/// std::invalid_argument as gospa and track_identity do.
TargetScores score_targets(std::span<const TargetMoment> moments, double cutoff_m);

}  // namespace alidade
