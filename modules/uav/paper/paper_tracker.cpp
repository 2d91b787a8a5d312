// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_tracker.h"

#include <algorithm>

namespace alidade {
namespace {

std::vector<PaperTarget> objects_of(std::span<const PaperPeriod> window, const PaperOptions& options) {
  std::vector<PaperTarget> targets;
  for (const PaperGroup& group : choose_objects(window, paper_groups(window, options), options)) {
    targets.push_back({static_cast<int>(targets.size()), window.back().index, group.estimate, group.score_m2,
                       bearings_of_group(window, group)});
  }
  return targets;
}

struct Continuation {
  std::size_t before, now;
  double distance_m;
};

// Nearest first; what continues nothing gets an id of its own.
void carry_ids(std::span<const PaperTarget> before, std::vector<PaperTarget>& now, double threshold_m, int& next_id) {
  std::vector<Continuation> continuations;
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t k = 0; k < now.size(); ++k) {
      const Eigen::Vector3d expected = moved_to(before[i].state, now[k].state.time).p_world;
      const double distance_m = (now[k].state.p_world - expected).norm();
      if (distance_m <= threshold_m) continuations.push_back({i, k, distance_m});
    }
  }
  std::stable_sort(continuations.begin(), continuations.end(),
                   [](const Continuation& a, const Continuation& b) { return a.distance_m < b.distance_m; });
  std::vector<bool> is_continued(before.size()), has_id(now.size());
  for (const Continuation& c : continuations) {
    if (is_continued[c.before] || has_id[c.now]) continue;
    is_continued[c.before] = has_id[c.now] = true;
    now[c.now].id = before[c.before].id;
  }
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (!has_id[k]) now[k].id = next_id++;
  }
}

}  // namespace

std::vector<PaperTarget> locate_paper_targets(std::span<const Bearing> bearings, const PaperOptions& options) {
  const std::vector<PaperPeriod> periods = paper_candidates(bearings, options);
  const auto length = static_cast<std::size_t>(options.periods);
  if (periods.size() < length) return {};
  return objects_of(std::span(periods).last(length), options);
}

std::vector<PaperTarget> track_paper_targets(std::span<const Bearing> bearings, const PaperOptions& options) {
  const std::vector<PaperPeriod> periods = paper_candidates(bearings, options);
  const auto length = static_cast<std::size_t>(options.periods);
  std::vector<PaperTarget> all, before;
  int next_id = 0;
  for (std::size_t first = 0; first + length <= periods.size(); ++first) {
    std::vector<PaperTarget> now = objects_of(std::span(periods).subspan(first, length), options);
    carry_ids(before, now, group_threshold_m(options), next_id);
    all.insert(all.end(), now.begin(), now.end());
    before = std::move(now);
  }
  return all;
}

}  // namespace alidade
