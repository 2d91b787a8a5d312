// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/receivers/known_track.h"
#include "tests/support/simulated_flight.h"

namespace alidade::test {

/// The true path of simulated flights at 5 Hz, from 2 s before the begin to 4 s after the end.
inline KnownTrack simulated_track(double duration_s) {
  std::vector<TimedPosition> positions;
  for (int i = -10; i < static_cast<int>(5.0 * duration_s) + 20; ++i) {
    positions.push_back({Timestamp(from_seconds(0.2 * i)), simulated_position(0.2 * i)});
  }
  return KnownTrack(positions);
}

}  // namespace alidade::test
