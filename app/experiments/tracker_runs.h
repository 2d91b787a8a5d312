// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/experiments/experiment_section.h"
#include "datasets/target_scene.h"
#include "evaluation/ensemble.h"
#include "evaluation/error_consistency.h"
#include "uav/tracker/target_tracker.h"

namespace alidade {

/// One condition of the tracker's experiments.
struct TrackerCell {
  std::string name;  ///< in tables, and the key in summary.json
  TargetSceneOptions scene;
  TargetTrackerOptions tracker;
  double shuffled_s = 0.0;  ///< bearings arrive in any order within so long
};

/// What the tracker made of a cell, over all runs. Estimates are looked at once a period, after its last look; those
/// that are tentative do not count.
struct TrackerScore {
  int runs = 0;
  double switches_per_run = 0.0, false_ids_per_run = 0.0, purity = 0.0, completeness = 0.0;
  double gospa_m = 0.0, ospa_m = 0.0;                             ///< RMS and mean over runs and periods
  double localisation_m2 = 0.0, missed_m2 = 0.0, false_m2 = 0.0;  ///< the parts of its square, means
  std::vector<double> gospa_m2;                                   ///< of each run
  double rms_m = 0.0;
  Ratio to_true_association;  ///< RMS, of the targets and periods that both filters answer
  Ratio to_bound;             ///< RMS to the posterior bound of the bearings that are truly of the target
  ErrorConsistency nees;      ///< of position and velocity, in the last period: errors of periods in a row are alike
  /// Periods from a target's first to its first estimate, and from its last to its estimate's last: of 99 % of the
  /// targets at most so many, and of the worst one. A target that is never found counts as found at the end.
  double found_99 = 0.0, found_worst = 0.0, given_up_99 = 0.0, given_up_worst = 0.0;
  double moved_by_shuffling_m = 0.0;  ///< the farthest that an estimate is from where it is in order of arrival
  double us_per_bearing = 0.0;        ///< CPU time of one thread, initiation included
};

/// All runs of a cell, several at once; the seed is context's and the run's number.
TrackerScore score_tracker(const TrackerCell& cell, const ExperimentContext& context);

nlohmann::json summary_of(const TrackerScore& score);

}  // namespace alidade
