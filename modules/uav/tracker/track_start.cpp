// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/track_start.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "uav/window/window_association.h"

namespace alidade {
namespace {

WindowOptions window_options(const TargetTrackerOptions& options) {
  WindowOptions window;
  window.period_s = options.period_s;
  window.detection_probability = options.detection_probability;
  window.false_bearings_per_sr = options.false_bearings_per_sr;
  window.top_speed_m_s = options.top_speed_m_s;
  window.gate_chi2 = options.gate_chi2;
  window.least_log_ratio = options.start_log_ratio;
  return window;
}

TargetTrack track_of(const TargetHypothesis& hypothesis, std::span<const Bearing> of_it,
                     const TargetTrackerOptions& options) {
  TargetTrack track;
  track.state = start_filter(hypothesis.fit.state, of_it, options);
  const double share = hypothesis.log_likelihood_ratio / static_cast<double>(of_it.size());
  for (const Bearing& bearing : of_it) {
    if (bearing.temperature_k) track.temperature.add(*bearing.temperature_k, 1.0);
    note_sighting(track, bearing, share, options);
  }
  return track;
}

}  // namespace

bool has_sightings_to_start(std::span<const Bearing> of_it, const TargetTrackerOptions& options) {
  constexpr double kThreeLooks = 1.5, kFourLooks = 2.5;  // periods; looks come one period apart, give or take a half
  constexpr double kLeastShare = 0.8;                    // of what its receivers could have seen of it in three looks
  constexpr int kFewer = 2;                              // suffice where they come from four looks
  if (of_it.empty()) return false;
  std::set<int> receivers;
  for (const Bearing& bearing : of_it) receivers.insert(bearing.receiver);
  const double could_be = 3.0 * static_cast<double>(receivers.size());
  const int needed = std::max(options.least_sightings, static_cast<int>(std::ceil(kLeastShare * could_be)));
  const double periods = to_seconds(of_it.back().time - of_it.front().time) / options.period_s;
  return (std::ssize(of_it) >= needed && periods > kThreeLooks) ||
         (std::ssize(of_it) >= needed - kFewer && periods > kFourLooks);
}

TargetState vague_state(const TargetState& about, const Bearing& first, const TargetTrackerOptions& options) {
  const double range = (about.p_world - first.origin_world).norm();
  const double acceleration = options.filter.motion.jerk_density > 0.0 ? options.acceleration_sigma_m_s2 : 0.0;
  TargetState state = about;
  state.covariance.setZero();
  state.covariance.diagonal().head<3>().setConstant(100.0 * range * range);
  state.covariance.diagonal().segment<3>(3).setConstant(options.top_speed_m_s * options.top_speed_m_s);
  state.covariance.diagonal().tail<3>().setConstant(acceleration * acceleration);
  return state;
}

TargetState start_filter(const TargetState& fit, std::span<const Bearing> bearings,
                         const TargetTrackerOptions& options) {
  BearingFilterOptions once = options.filter;
  once.max_iterations = 1;
  TargetState state = vague_state(moved_to(fit, bearings.front().time), bearings.front(), options);
  state.a_world.setZero();
  for (const Bearing& bearing : bearings) {
    state = predict(state, bearing.time, options.filter.motion);
    TargetState fitted = moved_to(fit, bearing.time);
    fitted.covariance = state.covariance;
    auto innovation = innovation_of(fitted, bearing, options.filter.added_sigma_rad);
    if (!innovation) continue;
    innovation->residual += innovation->J_residual_p * (state.p_world - fitted.p_world);
    state = absorb(state, bearing, *innovation, once);
  }
  return state;
}

TrackStarts start_tracks(std::vector<Bearing> bearings, const TargetTrackerOptions& options) {
  TrackStarts starts;
  std::vector<bool> is_taken(bearings.size(), false);
  for (const TargetHypothesis& hypothesis : associate_window(bearings, window_options(options))) {
    std::vector<Bearing> of_it;
    for (const std::size_t place : hypothesis.bearings) of_it.push_back(bearings[place]);
    const bool fits = hypothesis.fit.chi2 <= options.greatest_misfit * hypothesis.fit.degrees;
    if (!fits || !has_sightings_to_start(of_it, options)) continue;
    for (const std::size_t place : hypothesis.bearings) is_taken[place] = true;
    starts.tracks.push_back(track_of(hypothesis, of_it, options));
  }
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    if (!is_taken[i]) starts.unclaimed.push_back(bearings[i]);
  }
  return starts;
}

}  // namespace alidade
