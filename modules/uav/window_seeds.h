// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "uav/window_scans.h"
#include "uav/window_track.h"

namespace alidade {

/// Which targets' bearings are free: all, so that wrong guesses often meet one; or what settled tracks leave.
enum class Crowd { Whole, Rest };

/// Tracks of free bearings alone, each more probable than false bearings by the options' measure; the bearings of each
/// are taken (is_free becomes 0). From guesses through three bearings, then through two pairs, the longest times first;
/// what is explained is not asked again, which keeps the cost near the square of the number of targets.
std::vector<WindowTrack> find_tracks(const BearingWindow& window, Crowd crowd, std::vector<char>& is_free);

}  // namespace alidade
