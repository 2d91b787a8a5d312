// SPDX-License-Identifier: Apache-2.0
#include "evaluation/target_scores.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/median.h"

namespace alidade {
namespace {

std::vector<Eigen::Vector3d> places_of(std::span<const IdentifiedPosition> list) {
  std::vector<Eigen::Vector3d> places;
  for (const IdentifiedPosition& item : list) places.push_back(item.p_world);
  return places;
}

// Sums over the moments.
struct Sums {
  std::vector<double> distances_m;
  double squares_m2 = 0.0;
  ErrorConsistencyTally nees;

  void add_pairs(const TargetMoment& moment, double cutoff_m) {
    const auto partners = pair_by_place(moment, cutoff_m);
    for (std::size_t i = 0; i < partners.size(); ++i) {
      if (!partners[i]) continue;
      const IdentifiedPosition& estimate = moment.estimates[*partners[i]];
      const Eigen::Vector3d error = estimate.p_world - moment.truth[i].p_world;
      distances_m.push_back(error.norm());
      squares_m2 += error.squaredNorm();
      if (estimate.covariance) nees.add(error, *estimate.covariance);
    }
  }
};

}  // namespace

TargetScores score_targets(std::span<const TargetMoment> moments, double cutoff_m) {
  TargetScores scores;
  scores.moments = moments.size();
  scores.identity = track_identity(moments, cutoff_m);
  if (moments.empty()) return scores;
  const SetMetricOptions options{cutoff_m, 2.0};
  Sums sums;
  for (const TargetMoment& moment : moments) {
    const std::vector<Eigen::Vector3d> truth = places_of(moment.truth), estimates = places_of(moment.estimates);
    const Gospa g = gospa(truth, estimates, options);
    scores.gospa_m += g.total_m;
    scores.ospa_m += ospa(truth, estimates, options);
    scores.localisation_m2 += g.localisation;
    scores.missed_m2 += g.missed_cost;
    scores.false_m2 += g.false_cost;
    scores.count_right += truth.size() == estimates.size();
    sums.add_pairs(moment, cutoff_m);
  }
  const auto count = static_cast<double>(moments.size());
  for (double* mean : {&scores.gospa_m, &scores.ospa_m, &scores.localisation_m2, &scores.missed_m2, &scores.false_m2,
                       &scores.count_right}) {
    *mean /= count;
  }
  scores.pairs = sums.distances_m.size();
  if (scores.pairs > 0) {
    scores.rms_m = std::sqrt(sums.squares_m2 / static_cast<double>(scores.pairs));
    scores.median_m = median(std::move(sums.distances_m));
  }
  scores.nees = sums.nees.result();
  return scores;
}

}  // namespace alidade
