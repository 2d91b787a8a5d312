// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "uav/tracker/bearing_scans.h"
#include "uav/tracker/target_track.h"

namespace alidade {

/// Tracks after a scan.
struct ScanOutcome {
  std::vector<TargetTrack> tracks;
  std::vector<bool> is_claimed;  ///< per bearing of the scan: more probably of one of the tracks than not
};

/// The tracks, each updated with what the scan has of it; each bearing is taken at its own time. A track that was
/// missed keeps its state: misses are counted by note_misses, for a scan does not tell where it looked.
/// Source: Bar-Shalom, Willett, Tian, Tracking and Data Fusion, 2011, sections 6.2 (JPDA) and 6.3 (global nearest
/// neighbour).
ScanOutcome take_scan(std::vector<TargetTrack> tracks, const BearingScan& scan, const TargetTrackerOptions& options);

}  // namespace alidade
