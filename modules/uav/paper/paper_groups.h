// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "uav/paper/paper_candidates.h"

namespace alidade {

/// Candidates, one a period, that lie as one object's would.
struct PaperGroup {
  std::vector<std::size_t> candidates;  ///< by period: index among its candidates
  TargetState estimate;                 ///< at the last candidate's time
  /// Sum of the candidates' J and of their squared distances from where the group was expected.
  double score_m2 = 0.0;
};

/// All groups that reach from the first of `periods` to the last, best (least score) first.
/// Alternative: pairs of candidates of the first two periods start groups; each candidate within the threshold of a
/// group's extrapolation continues it in a group of its own, whose position and velocity are then estimated anew from
/// all its candidates at their times (straight line, least squares). Proposed: each candidate of the first period
/// starts a group by its own velocity, and a continued group takes over the latest candidate's state. A period without
/// a continuation ends a group. Of one period alone, each candidate is a group. Empty without periods.
/// Source: UAV paper, "Alternative algorithm" and "Proposed algorithm". J of three lines of sight is 0 whatever they
/// are of, so that the score counts the distances as well, with both algorithms.
std::vector<PaperGroup> paper_groups(std::span<const PaperPeriod> periods, const PaperOptions& options);

/// The groups that are objects: in their order, each that shares at most shared_bearings bearings with any chosen
/// before. Their number is the number of objects found.
std::vector<PaperGroup> choose_objects(std::span<const PaperPeriod> periods, std::span<const PaperGroup> groups,
                                       const PaperOptions& options);

/// The indices of a group's bearings, by period.
std::vector<std::size_t> bearings_of_group(std::span<const PaperPeriod> periods, const PaperGroup& group);

}  // namespace alidade
