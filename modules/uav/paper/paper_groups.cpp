// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_groups.h"

#include <algorithm>
#include <set>
#include <utility>

namespace alidade {
namespace {

const PaperCandidate& candidate_of(std::span<const PaperPeriod> periods, const PaperGroup& group, std::size_t period) {
  return periods[period].candidates[group.candidates[period]];
}

// The straight line through a group's candidates, at the last one's time. With x(t) = Σ w_j(t) M_j the covariance is
// that of a sum: bearings of different periods err independently.
TargetState fitted_line(std::span<const PaperPeriod> periods, const PaperGroup& group) {
  const std::size_t n = group.candidates.size();
  TargetState line;
  line.time = candidate_of(periods, group, n - 1).state.time;
  const auto since_last = [&](std::size_t j) {
    return to_seconds(candidate_of(periods, group, j).state.time - line.time);
  };
  double sum_t = 0.0, sum_t2 = 0.0;
  for (std::size_t j = 0; j < n; ++j) sum_t += since_last(j), sum_t2 += since_last(j) * since_last(j);
  const double count = static_cast<double>(n), determinant = count * sum_t2 - sum_t * sum_t;
  for (std::size_t j = 0; j < n; ++j) {
    const TargetState& state = candidate_of(periods, group, j).state;
    Eigen::Vector2d weight((sum_t2 - sum_t * since_last(j)) / determinant,
                           (count * since_last(j) - sum_t) / determinant);
    if (n == 1) weight = {1.0, 0.0};
    line.p_world += weight[0] * state.p_world;
    line.v_world += weight[1] * state.p_world;
    for (int row = 0; row < 2; ++row) {
      for (int column = 0; column < 2; ++column) {
        line.covariance.block<3, 3>(3 * row, 3 * column) +=
            weight[row] * weight[column] * state.covariance.topLeftCorner<3, 3>();
      }
    }
  }
  return line;
}

Eigen::Vector3d extrapolated(const TargetState& state, Timestamp time) {
  const double dt = to_seconds(time - state.time);
  return state.p_world + dt * (state.v_world + 0.5 * dt * state.a_world);
}

void estimate(std::span<const PaperPeriod> periods, const PaperOptions& options, PaperGroup& group) {
  group.estimate = options.method == PaperMethod::Alternative
                       ? fitted_line(periods, group)
                       : candidate_of(periods, group, group.candidates.size() - 1).state;
}

std::vector<PaperGroup> first_groups(std::span<const PaperPeriod> periods, const PaperOptions& options) {
  std::vector<PaperGroup> groups;
  for (std::size_t i = 0; i < periods[0].candidates.size(); ++i) {
    groups.push_back({{i}, {}, periods[0].candidates[i].residual_m2});
    estimate(periods, options, groups.back());
  }
  return groups;
}

// Each group with each of the next period's candidates that continues it.
std::vector<PaperGroup> continued(std::span<const PaperPeriod> periods, const std::vector<PaperGroup>& groups,
                                  const PaperOptions& options) {
  const double threshold_m = group_threshold_m(options);
  std::vector<PaperGroup> longer;
  for (const PaperGroup& group : groups) {
    const std::size_t period = group.candidates.size();
    const bool has_velocity = period > 1 || options.method == PaperMethod::Proposed;
    const auto& candidates = periods[period].candidates;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const Eigen::Vector3d expected = extrapolated(group.estimate, candidates[i].state.time);
      const double distance2 = has_velocity ? (candidates[i].state.p_world - expected).squaredNorm() : 0.0;
      if (!(distance2 <= threshold_m * threshold_m)) continue;
      longer.push_back(group);
      longer.back().candidates.push_back(i);
      longer.back().score_m2 += candidates[i].residual_m2 + distance2;
    }
  }
  return longer;
}

void keep_best(std::vector<PaperGroup>& groups, std::size_t most) {
  std::stable_sort(groups.begin(), groups.end(),
                   [](const PaperGroup& a, const PaperGroup& b) { return a.score_m2 < b.score_m2; });
  if (groups.size() > most) groups.resize(most);
}

}  // namespace

std::vector<PaperGroup> paper_groups(std::span<const PaperPeriod> periods, const PaperOptions& options) {
  validate(options);
  if (periods.empty()) return {};
  std::vector<PaperGroup> groups = first_groups(periods, options);
  keep_best(groups, options.most_groups);
  for (std::size_t period = 1; period < periods.size() && !groups.empty(); ++period) {
    groups = continued(periods, groups, options);
    keep_best(groups, options.most_groups);
    for (PaperGroup& group : groups) estimate(periods, options, group);
  }
  return groups;
}

std::vector<std::size_t> bearings_of_group(std::span<const PaperPeriod> periods, const PaperGroup& group) {
  std::vector<std::size_t> bearings;
  for (std::size_t period = 0; period < group.candidates.size(); ++period) {
    const auto& of_period = candidate_of(periods, group, period).bearings;
    bearings.insert(bearings.end(), of_period.begin(), of_period.end());
  }
  return bearings;
}

std::vector<PaperGroup> choose_objects(std::span<const PaperPeriod> periods, std::span<const PaperGroup> groups,
                                       const PaperOptions& options) {
  std::vector<PaperGroup> objects;
  std::vector<std::set<std::size_t>> taken;
  for (const PaperGroup& group : groups) {
    const std::vector<std::size_t> bearings = bearings_of_group(periods, group);
    const bool is_free = std::all_of(taken.begin(), taken.end(), [&](const std::set<std::size_t>& other) {
      return std::count_if(bearings.begin(), bearings.end(), [&](std::size_t b) { return other.contains(b); }) <=
             options.shared_bearings;
    });
    if (!is_free) continue;
    objects.push_back(group);
    taken.emplace_back(bearings.begin(), bearings.end());
  }
  return objects;
}

}  // namespace alidade
