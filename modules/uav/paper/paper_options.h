// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "uav/paper/paper_geometry.h"

namespace alidade {

/// The two algorithms of the paper.
enum class PaperMethod {
  Alternative,  ///< pairs of bearings of two receivers, taken as if they looked at once; velocity from differences
  Proposed,     ///< one bearing of each of three or more receivers; velocity within a period
};

/// Options of the paper's algorithms. The thresholds are those that re-create its tables.
struct PaperOptions {
  PaperMethod method = PaperMethod::Proposed;
  double period_s = 1.0;  ///< a bearing belongs to period floor(t / period_s)
  int periods = 5;        ///< N: as long as a group must be; the paper's
  /// How far two lines of sight may pass each other, m (√J). It must let through what a target moves in a delay: at
  /// 60 m/s and 0.3 s 18 m.
  double pair_threshold_m = 20.0;
  /// How far a continuation may lie from a group's extrapolation, m: of the alternative algorithm the change of its
  /// delay's error from period to period, of the proposed one its velocity's error times the period.
  double alternative_group_m = 3.0;
  double proposed_group_m = 10.0;
  int shared_bearings = 0;  ///< how many two objects may have in common; 0: the paper's usual case
  /// What the target does within a period (proposed); an acceleration needs five receivers, periods with fewer get on
  /// with the velocity.
  PaperMotion motion = PaperMotion::Velocity;
  std::size_t most_groups = 5000;  ///< kept after each period, best first: bounds the growth in clutter
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const PaperOptions& options);

/// The group threshold of the options' method, m.
double group_threshold_m(const PaperOptions& options);

}  // namespace alidade
