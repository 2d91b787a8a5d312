// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "uav/window/window_scans.h"
#include "uav/window/window_track.h"

namespace alidade {

/// Which targets' bearings are free: all, so that wrong guesses often meet one; or what settled tracks leave.
enum class Crowd { Whole, Rest };

/// A round of search.
struct SearchRound {
  Crowd crowd = Crowd::Whole;
  /// Of what a target's bearings usually gain: less is left for a later round, because a few bearings of several
  /// targets may look like one more as long as these are not found.
  double least_share = 0.4;
};

/// Tracks of free bearings alone, each more probable than false bearings by the options' measure; the bearings of each
/// are taken (is_free becomes 0). From guesses through three bearings, then through two pairs, the longest times first;
/// what is explained is not asked again, which keeps the cost near the square of the number of targets.
std::vector<WindowTrack> find_tracks(const BearingWindow& window, const SearchRound& round, std::vector<char>& is_free);

}  // namespace alidade
