// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "uav/tracker/target_track.h"

namespace alidade {

/// New tracks, without an id yet, and the bearings that none of them took.
struct TrackStarts {
  std::vector<TargetTrack> tracks;
  std::vector<Bearing> unclaimed;
};

/// Tracks of the targets that bearings in order of time tell of surely enough: start_log_ratio, greatest_misfit, and
/// has_sightings_to_start.
TrackStarts start_tracks(std::vector<Bearing> bearings, const TargetTrackerOptions& options);

/// Whether the bearings of a new target, in order of time, are enough for a track: least_sightings, and four fifths of
/// what its receivers could have seen of it, in three looks at least; two fewer will do where they are spread over
/// four.
bool has_sightings_to_start(std::span<const Bearing> of_it, const TargetTrackerOptions& options);

/// A state that knows next to nothing, at the time and about the place of `about`: what a filter of a target starts
/// with that `first` has seen.
TargetState vague_state(const TargetState& about, const Bearing& first, const TargetTrackerOptions& options);

/// The state of a filter over a new target's bearings in order of time. It begins knowing next to nothing about where
/// the target is, but linearises all of them about `fit`: a range that is hardly known would bend its first steps.
TargetState start_filter(const TargetState& fit, std::span<const Bearing> bearings,
                         const TargetTrackerOptions& options);

}  // namespace alidade
