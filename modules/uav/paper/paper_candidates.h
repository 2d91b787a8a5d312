// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "uav/paper/paper_options.h"
#include "uav/target_state.h"

namespace alidade {

/// Where bearings of one period would meet, were they of one target.
struct PaperCandidate {
  TargetState state;  ///< at the time of the first receiver's bearing; the alternative algorithm's has no velocity
  double residual_m2 = 0.0;           ///< J
  std::vector<std::size_t> bearings;  ///< which ones, in order of their receivers' ids
};

/// All candidates of one period.
struct PaperPeriod {
  std::int64_t index = 0;  ///< floor(t / period_s)
  std::vector<PaperCandidate> candidates;
};

/// The candidates of every period from the first bearing's to the last's, also of those in between that have none.
/// Alternative: every pair of bearings of the two receivers with the least ids that occur. Proposed: every choice of
/// one bearing of each receiver that has any in the period, if these are three or more. Left out are those of which two
/// lines of sight pass each other farther than pair_threshold_m, or that lie behind a receiver. Bearings may be in any
/// order. Empty without bearings, or where fewer than two receivers (proposed: three) occur. Throws
/// std::invalid_argument for options, or a bearing, that cannot be.
/// Source: UAV paper eqs. 8 to 11.
std::vector<PaperPeriod> paper_candidates(std::span<const Bearing> bearings, const PaperOptions& options);

}  // namespace alidade
