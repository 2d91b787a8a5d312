// SPDX-License-Identifier: Apache-2.0
#include "evaluation/flight_score.h"

#include <cmath>
#include <vector>

#include "evaluation/statistics.h"
#include "geometry/alignment.h"

namespace alidade {

FlightScore score_flight(std::span<const PositionPair> pairs) {
  std::vector<Eigen::Vector3d> estimate, truth;
  std::vector<double> errors_m, per_sigma;
  for (const PositionPair& pair : pairs) {
    estimate.push_back(pair.estimate);
    truth.push_back(pair.truth);
    errors_m.push_back((pair.estimate - pair.truth).norm());
    const double trace = pair.covariance.trace();
    if (trace > 0.0) per_sigma.push_back(errors_m.back() / std::sqrt(trace));
  }
  const Statistics raw = summarise(errors_m);
  FlightScore score{raw.count, raw.rmse, raw.median, raw.max, std::nullopt, std::nullopt};
  if (!per_sigma.empty()) score.error_per_sigma = summarise(per_sigma).median;
  const auto similarity = align_points(estimate, truth, AlignmentKind::Similarity);
  if (!similarity) return score;
  for (std::size_t i = 0; i < pairs.size(); ++i) errors_m[i] = (*similarity * estimate[i] - truth[i]).norm();
  score.aligned_rmse_m = summarise(errors_m).rmse;
  return score;
}

}  // namespace alidade
