// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "uav/paper/paper_groups.h"

namespace alidade {

/// An object that the paper's algorithm found in the N periods that end with `period`.
struct PaperTarget {
  int id = 0;               ///< the same in windows that follow each other
  std::int64_t period = 0;  ///< the last one: floor(t / period_s)
  /// At the time of the last period's first bearing. The covariance is from the bearings' noise alone: it knows nothing
  /// of what the alternative algorithm errs by because it takes all bearings of a period to be of one moment.
  TargetState state;
  double score_m2 = 0.0;              ///< PaperGroup::score_m2
  std::vector<std::size_t> bearings;  ///< indices, by period and receiver
};

/// The objects in the last N periods of the bearings; ids count from 0, by score. Empty where the bearings reach over
/// fewer periods, or too few receivers (two, of the proposed algorithm three) report any. Throws std::invalid_argument
/// for options, or a bearing, that cannot be.
/// Source: UAV paper, "Alternative algorithm" and "Proposed algorithm".
std::vector<PaperTarget> locate_paper_targets(std::span<const Bearing> bearings, const PaperOptions& options);

/// The objects of a whole recording: those of each window of N periods in succession, in order of time. An object
/// bears the id of the one in the window before that it continues nearest, within the group threshold. Throws as
/// above. (Windows and identities are ours; the paper ends after N periods.)
std::vector<PaperTarget> track_paper_targets(std::span<const Bearing> bearings, const PaperOptions& options);

}  // namespace alidade
