// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera/measurement.h"
#include "camera/receiver.h"

namespace alidade::test {

/// Cameras in a circle that watch something fly loops above them, 20 frames a second, none at the same time.
struct SimulatedFlight {
  std::vector<Receiver> receivers;  ///< as they are believed to be
  std::vector<ReceiverReading> readings;
};

struct SimulatedFlightOptions {
  int receivers = 4;
  double duration_s = 30.0;
  double noise_px = 0.5;
  std::vector<double> clock_errors_s{};      ///< of the true clocks from what is believed; 0 where there are fewer
  double clock_sigma_s = 0.0;                ///< as it is stated
  std::vector<Eigen::Vector2d> turns_rad{};  ///< of the true poses about their x and y axes
  double turn_sigma_rad = 1e-4;              ///< as it is stated
  unsigned seed = 1;
};

SimulatedFlight simulate_flight(const SimulatedFlightOptions& options);

/// Where the target of every simulated flight is, m, t seconds after the begin.
Eigen::Vector3d simulated_position(double t_s);

}  // namespace alidade::test
