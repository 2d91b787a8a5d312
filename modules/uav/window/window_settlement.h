// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "uav/window/window_scans.h"
#include "uav/window/window_track.h"

namespace alidade {

/// The tracks that share out the window's bearings best: in each scan the assignment of greatest log-likelihood by all
/// tracks' motions together, then all motions anew, until nothing changes; a track that is left with less than the
/// options' least log-likelihood ratio goes, the least probable first.
std::vector<WindowTrack> settle_tracks(const BearingWindow& window, std::vector<WindowTrack> tracks);

}  // namespace alidade
