// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/target_track.h"

#include <algorithm>
#include <cmath>

namespace alidade {
namespace {

constexpr double kDuePeriods = 1.5;  // looks come a period apart, give or take a half
constexpr int kMostMisses = 5;

}  // namespace

void TemperatureReadings::add(double temperature_k, double weight) {
  if (!(weight > 0.0)) return;
  count += weight;
  const double off = temperature_k - mean_k;
  mean_k += off * weight / count;
  squares_k2 += weight * off * (temperature_k - mean_k);
}

double TemperatureReadings::spread_k() const {
  return count > 0.0 ? std::sqrt(squares_k2 / count) : 0.0;
}

void note_sighting(TargetTrack& track, const Bearing& bearing, double log_ratio, const TargetTrackerOptions& options) {
  ++track.sightings;
  track.last_seen = std::max(track.last_seen, bearing.time);
  track.evidence += log_ratio;
  track.log_ratio = std::min(options.greatest_log_ratio, track.log_ratio + log_ratio);
  if (track.evidence >= options.confirm_log_ratio) track.is_confirmed = true;
  const auto watch = std::find_if(track.watches.begin(), track.watches.end(),
                                  [&](const TargetTrack::Watch& w) { return w.receiver == bearing.receiver; });
  if (watch == track.watches.end()) {
    track.watches.push_back({bearing.receiver, bearing.time, 0});
  } else {
    *watch = {bearing.receiver, bearing.time, 0};
  }
}

void note_misses(TargetTrack& track, Timestamp time, const TargetTrackerOptions& options) {
  const auto due = from_seconds(kDuePeriods * options.period_s), period = from_seconds(options.period_s);
  const double log_ratio = std::log(1.0 - options.detection_probability);
  for (TargetTrack::Watch& watch : track.watches) {
    while (watch.misses < kMostMisses && time >= watch.last + due) {
      watch.last += period;
      ++watch.misses;
      track.evidence += log_ratio;
      track.log_ratio += log_ratio;
    }
  }
}

bool is_gone(const TargetTrack& track, Timestamp time, const TargetTrackerOptions& options) {
  return track.log_ratio <= 0.0 || time >= track.last_seen + from_seconds(options.patience_periods * options.period_s);
}

bool is_coasting(const TargetTrack& track, Timestamp time, const TargetTrackerOptions& options) {
  return time >= track.last_seen + from_seconds(kDuePeriods * options.period_s);
}

}  // namespace alidade
