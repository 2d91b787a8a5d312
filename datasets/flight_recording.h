// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "camera/measurement.h"
#include "camera/receiver.h"
#include "core/time.h"
#include "geometry/positions.h"

namespace alidade {

/// A real flight of one target, watched by receivers on the ground and by its own satellite navigation.
struct FlightRecording {
  std::vector<Receiver> receivers;        ///< with pose and clock as the folder gives them; no covariances
  std::vector<ReceiverReading> readings;  ///< all of the one target, in the order of the file; times are frame / fps
  std::vector<TimedPosition> truth;       ///< in order of the common clock
  Timestamp flight_begin{}, flight_end{};
  Timestamp used_until{};  ///< poses and clocks were fitted to the truth before it: score after it
};

/// Reads a folder of receivers.yaml, observations.csv (t, receiver, frame, u, v) and groundtruth.csv (t, x, y, z), as
/// our conversion of the ETH drone-tracking data sets writes it. A receiver's own clock is its frame count over its
/// nominal rate; Receiver::sigma is the stated median residual over that of a normal distribution in the plane.
/// Column t of the observations is checked against the clocks, to 1 ms. Throws InputError with the line for what is
/// damaged, missing or contradicts itself.
FlightRecording read_flight(const std::filesystem::path& folder);

}  // namespace alidade
