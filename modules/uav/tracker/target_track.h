// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "uav/target_state.h"
#include "uav/tracker/target_tracker_options.h"

namespace alidade {

/// Temperatures that receivers read of one target.
struct TemperatureReadings {
  double count = 0.0;  ///< sum of the weights
  double mean_k = 0.0;
  double squares_k2 = 0.0;  ///< sum of squares about the mean

  void add(double temperature_k, double weight);
  double spread_k() const;  ///< standard deviation of a reading; 0 where there is none
};

/// What is believed of one target while it is followed.
struct TargetTrack {
  /// When a receiver that sees the target has seen it last, or should have.
  struct Watch {
    int receiver = 0;
    Timestamp last{};
    int misses = 0;  ///< in a row
  };

  int id = 0;
  TargetState state;
  bool is_confirmed = false;
  double evidence = 0.0;   ///< ln of how much more probable it is than false bearings
  double log_ratio = 0.0;  ///< the same, but never above greatest_log_ratio: what it lives on
  int sightings = 0;
  Timestamp last_seen{};
  std::vector<Watch> watches;
  TemperatureReadings temperature;
};

/// Takes note that a receiver has seen the target, with the ln of how much more probable that made it.
void note_sighting(TargetTrack& track, const Bearing& bearing, double log_ratio, const TargetTrackerOptions& options);

/// Takes note of the receivers that should have seen the target since they last did: one miss a period, from one and a
/// half periods on. A receiver that has missed it often looks elsewhere and does not count.
void note_misses(TargetTrack& track, Timestamp time, const TargetTrackerOptions& options);

/// Whether the track is to be given up.
bool is_gone(const TargetTrack& track, Timestamp time, const TargetTrackerOptions& options);

/// Whether nobody has seen the target for one and a half periods.
bool is_coasting(const TargetTrack& track, Timestamp time, const TargetTrackerOptions& options);

}  // namespace alidade
