// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include "app/targets/receiver_calibration_input.h"
#include "tests/support/simulated_flight.h"

namespace alidade::test {

inline constexpr double kFlight_s = 30.0;

/// By how much receiver 1 is given wrong: place and direction along its own axes, and clock.
inline Vector6d disturbance() {
  return (Vector6d() << 0.3, -0.2, 0.4, 0.008, -0.006, 0.005).finished();
}
inline constexpr double kClockError_s = 0.06;

/// The path of simulated flights at 5 Hz, from 3 s before the begin to 5 s after the end.
inline std::vector<TimedPosition> simulated_path() {
  std::vector<TimedPosition> path;
  for (int i = -15; i < static_cast<int>(5.0 * kFlight_s) + 25; ++i) {
    path.push_back({Timestamp(from_seconds(0.2 * i)), simulated_position(0.2 * i)});
  }
  return path;
}

/// A simulated flight whose receiver 1 stands elsewhere, looks elsewhere and whose clock is late; the path is known.
inline ReceiverCalibrationInput disturbed_flight() {
  auto [receivers, readings] = simulate_flight({.receivers = 3, .duration_s = kFlight_s});
  ReceiverCalibrationInput input;
  input.sources = {"receivers.yaml", "observations.csv", "path.csv", {}, {}};
  input.receivers = receivers;
  for (Receiver& receiver : input.receivers) receiver.name = "cam" + std::to_string(receiver.id);
  Receiver& off = input.receivers[1];
  off.T_world_receiver = off.T_world_receiver * perturbation(disturbance());
  off.clock.offset_s += kClockError_s;
  input.readings = readings;
  std::stable_sort(input.readings.begin(), input.readings.end(),
                   [](const auto& a, const auto& b) { return a.receiver < b.receiver; });
  input.truth = simulated_path();
  return input;
}

}  // namespace alidade::test
