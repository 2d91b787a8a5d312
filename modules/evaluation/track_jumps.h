// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/positions.h"

namespace alidade {

struct TrackJumpOptions {
  int neighbours = 4;         ///< on each side; at 5 Hz less than a second, in which a parabola follows a multicopter
  double scale_m = 0.05;      ///< farther off the neighbours' path a position counts less (Cauchy)
  double least_jump_m = 0.3;  ///< what a parabola misses in a brisk turn is a third of it
};

/// The positions of a track (indices) that their own neighbours contradict: they lie off the parabola through these by
/// more than least_jump_m. A fault of the track, found from it alone: nothing that flies jumps aside and back between
/// two positions. The first and the last `neighbours` are taken as they are. Throws std::invalid_argument for options
/// that are not positive.
std::vector<std::size_t> track_jumps(std::span<const TimedPosition> track, const TrackJumpOptions& options = {});

}  // namespace alidade
