// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "uav/tracker/bearing_scans.h"
#include "uav/tracker/target_track.h"

namespace alidade {

/// All that is believed after some scans: the tracks, and the bearings that may yet become one.
struct TrackBook {
  std::vector<TargetTrack> tracks;
  std::vector<Bearing> unclaimed;  ///< of the last window_periods, in order of time
  int next_id = 1;
};

/// The book after one more scan: tracks take their bearings, those that nobody sees are given up, and the bearings that
/// are left start new ones. Scans come in order of their begins.
TrackBook after_scan(TrackBook book, const BearingScan& scan, const TargetTrackerOptions& options);

/// A track at a later time, without any further scan; its misses are counted.
TargetTrack without_scans(TargetTrack track, Timestamp time, const TargetTrackerOptions& options);

}  // namespace alidade
