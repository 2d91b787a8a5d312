// SPDX-License-Identifier: Apache-2.0
#include "evaluation/detection_match.h"

#include <algorithm>

namespace alidade {
namespace {

struct Pair {
  double distance_px;
  std::size_t truth, detection;
};

}  // namespace

std::vector<std::optional<std::size_t>> match_detections(std::span<const Eigen::Vector2d> truth,
                                                         std::span<const Eigen::Vector2d> detections, double most_px) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t j = 0; j < detections.size(); ++j) {
      const double distance_px = (truth[i] - detections[j]).norm();
      if (distance_px <= most_px) pairs.push_back({distance_px, i, j});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance_px < b.distance_px; });
  std::vector<std::optional<std::size_t>> match(truth.size());
  std::vector<bool> is_taken(detections.size(), false);
  for (const Pair& pair : pairs) {
    if (match[pair.truth] || is_taken[pair.detection]) continue;
    match[pair.truth] = pair.detection;
    is_taken[pair.detection] = true;
  }
  return match;
}

}  // namespace alidade
