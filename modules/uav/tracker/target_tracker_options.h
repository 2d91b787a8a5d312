// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "uav/tracker/bearing_filter.h"

namespace alidade {

/// How the bearings of a scan are given to tracks.
enum class ScanAssociation {
  NearestNeighbour,  ///< global: the most probable way to give bearings to tracks one to one
  Joint,             ///< each track is updated with all bearings by their probability over all such ways (JPDA)
};

struct TargetTrackerOptions {
  BearingFilterOptions filter;
  ScanAssociation association = ScanAssociation::Joint;
  double period_s = 1.0;  ///< in which each receiver looks at each target about once
  /// How long one look at the sky takes, s: bearings of one receiver that are nearer in time are of different targets.
  double scan_s = 0.03;
  /// How late a bearing may arrive, s of the receivers' clock after the newest one; later ones are left out.
  double lag_s = 1.0;

  double detection_probability = 0.9;   ///< of a target in a look
  double false_bearings_per_sr = 10.0;  ///< their mean number in a look, per steradian; 10: one in a cone of 20°
  double gate_chi2 = 20.0;              ///< of 2 degrees of freedom; 20 loses one bearing in 22,000

  double top_speed_m_s = 60.0;  ///< of targets that appear
  /// Of each coordinate of an acceleration that is estimated (jerk_density > 0), before anything is seen.
  double acceleration_sigma_m_s2 = 3.0;
  double window_periods = 4.0;  ///< bearings without a track are kept so long for new tracks to start from
  /// Of a new track: 10 of its equations then test the 6 unknowns. With 6 sightings, one target in 30 among five of its
  /// like starts from a mixture of bearings; with 8, none in 1000.
  int least_sightings = 8;
  double greatest_misfit = 2.5;      ///< of a new track: χ² per degree of freedom; right ones exceed it once in 200
  double start_log_ratio = 12.0;     ///< ln of how much more probable a new track is than false bearings
  double confirm_log_ratio = 25.0;   ///< the same with the sightings since: from here on it is taken for real
  double greatest_log_ratio = 15.0;  ///< that a track can live on: five misses in a row at 95 % detection
  double patience_periods = 5.0;     ///< a track that nobody has seen for so long is given up anyhow

  double temperature_sigma_k = 0.0;   ///< of a reading about its target's; > 0: readings help to tell targets apart
  double temperature_span_k = 100.0;  ///< over which readings of false bearings and new targets are spread
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const TargetTrackerOptions& options);

}  // namespace alidade
