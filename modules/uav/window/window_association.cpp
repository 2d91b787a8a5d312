// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_association.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "uav/window/window_scans.h"
#include "uav/window/window_seeds.h"
#include "uav/window/window_settlement.h"

namespace alidade {
namespace {

// The first finds nearly all; the others seek among what is left, what shows clearly first.
constexpr std::array<SearchRound, 4> kRounds{
    {{Crowd::Whole, 0.4}, {Crowd::Rest, 0.25}, {Crowd::Rest, 0.0}, {Crowd::Rest, 0.0}}};

void require(bool is_so, const char* field, const char* bound, double value) {
  if (!is_so) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

std::vector<char> free_beside(const BearingWindow& window, const std::vector<WindowTrack>& tracks) {
  std::vector<char> is_free(window.rows.size(), 1);
  for (const WindowTrack& track : tracks) {
    for (const std::size_t bearing : track.bearing_of_scan) {
      if (bearing != kNoBearing) is_free[bearing] = 0;
    }
  }
  return is_free;
}

TargetHypothesis hypothesis_of(const BearingWindow& window, const WindowTrack& track) {
  TargetState state;
  state.time = window.frame.reference;
  state.p_world = window.frame.anchor_world + track.motion.x.head<3>();
  state.v_world = track.motion.x.tail<3>();
  state.covariance.topLeftCorner<6, 6>() = track.motion.covariance;
  TargetHypothesis hypothesis;
  for (const std::size_t bearing : track.bearing_of_scan) {
    if (bearing != kNoBearing) hypothesis.bearings.push_back(bearing);
  }
  std::sort(hypothesis.bearings.begin(), hypothesis.bearings.end());
  hypothesis.fit.state = moved_to(state, window.frame.reference + from_seconds(window.end_s));
  hypothesis.fit.chi2 = track.motion.chi2;
  hypothesis.fit.degrees = 2 * static_cast<int>(hypothesis.bearings.size()) - 6;
  hypothesis.log_likelihood_ratio = track.log_ratio;
  return hypothesis;
}

}  // namespace

void validate(const WindowOptions& o) {
  const auto is_probability = [](double p) { return p > 0.0 && p < 1.0; };
  require(o.period_s >= 0.0, "period_s", ">= 0 s", o.period_s);
  require(is_probability(o.detection_probability), "detection_probability", "in (0, 1)", o.detection_probability);
  require(o.false_bearings_per_sr > 0.0, "false_bearings_per_sr", "> 0", o.false_bearings_per_sr);
  require(o.target_density_m3 > 0.0, "target_density_m3", "> 0", o.target_density_m3);
  require(is_probability(o.appearance_probability), "appearance_probability", "in (0, 1)", o.appearance_probability);
  require(o.top_speed_m_s > 0.0, "top_speed_m_s", "> 0 m/s", o.top_speed_m_s);
  require(o.greatest_range_m > 0.0, "greatest_range_m", "> 0 m", o.greatest_range_m);
  require(o.gate_chi2 > 0.0, "gate_chi2", "> 0", o.gate_chi2);
}

std::vector<TargetHypothesis> associate_window(std::span<const Bearing> bearings, const WindowOptions& options) {
  validate(options);
  if (bearings.empty()) return {};
  const BearingWindow window = prepare_window(bearings, options);
  std::vector<WindowTrack> tracks;
  for (const SearchRound& round : kRounds) {
    std::vector<char> is_free = free_beside(window, tracks);
    std::vector<WindowTrack> found = find_tracks(window, round, is_free);
    if (found.empty()) {
      if (round.least_share > 0.0) continue;
      break;
    }
    std::move(found.begin(), found.end(), std::back_inserter(tracks));
    tracks = settle_tracks(window, std::move(tracks));
  }
  std::stable_sort(tracks.begin(), tracks.end(),
                   [](const WindowTrack& a, const WindowTrack& b) { return a.log_ratio > b.log_ratio; });
  std::vector<TargetHypothesis> hypotheses;
  for (const WindowTrack& track : tracks) hypotheses.push_back(hypothesis_of(window, track));
  return hypotheses;
}

}  // namespace alidade
