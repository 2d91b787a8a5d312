// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/known_target.h"

#include <algorithm>

#include "uav/batch/motion_fit.h"
#include "uav/tracker/track_start.h"

namespace alidade {
namespace {

std::span<const Bearing> until(std::span<const Bearing> bearings, Timestamp time) {
  const auto end = std::find_if(bearings.begin(), bearings.end(), [&](const Bearing& b) { return b.time > time; });
  return bearings.first(static_cast<std::size_t>(end - bearings.begin()));
}

std::optional<TargetState> started(std::span<const Bearing> bearings, const TargetTrackerOptions& options) {
  if (!has_sightings_to_start(bearings, options)) return std::nullopt;
  const MotionAnswer answer = fit_motion(bearings);
  if (!answer.fit) return std::nullopt;
  return start_filter(answer.fit->state, bearings, options);
}

}  // namespace

std::vector<std::optional<TargetState>> follow_known_target(std::span<const Bearing> of_it,
                                                            std::span<const Timestamp> times,
                                                            const TargetTrackerOptions& options) {
  std::vector<std::optional<TargetState>> states;
  std::optional<TargetState> state;
  std::size_t taken = 0;
  for (const Timestamp time : times) {
    const auto known = until(of_it, time);
    state = state ? filter_bearings(*state, known.subspan(taken), options.filter) : started(known, options);
    taken = known.size();
    states.push_back(state ? std::optional(predict(*state, time, options.filter.motion)) : std::nullopt);
  }
  return states;
}

std::vector<std::optional<TargetState>> tracking_bound(std::span<const Bearing> of_it, std::span<const Timestamp> times,
                                                       const std::function<TargetState(Timestamp)>& truth,
                                                       const TargetTrackerOptions& options) {
  std::vector<std::optional<TargetState>> bounds;
  if (of_it.empty()) return std::vector<std::optional<TargetState>>(times.size());
  const auto true_with = [&](const TargetState& bound) {
    TargetState state = truth(bound.time);
    state.time = bound.time;
    state.covariance = bound.covariance;
    return state;
  };
  BearingFilterOptions once = options.filter;
  once.max_iterations = 1;
  TargetState state = vague_state(truth(of_it.front().time), of_it.front(), options);
  std::size_t taken = 0;
  for (const Timestamp time : times) {
    const auto known = until(of_it, time);
    for (; taken < known.size(); ++taken) {
      state = true_with(predict(state, known[taken].time, options.filter.motion));
      const auto innovation = innovation_of(state, known[taken], options.filter.added_sigma_rad);
      if (innovation) state = absorb(state, known[taken], *innovation, once);
    }
    const bool is_known = has_sightings_to_start(known, options);
    bounds.push_back(is_known ? std::optional(true_with(predict(state, time, options.filter.motion))) : std::nullopt);
  }
  return bounds;
}

}  // namespace alidade
