// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulated_flight.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace alidade::test {
namespace {

constexpr double kRate_hz = 20.0;

Receiver receiver_in_circle(int k, int count, const SimulatedFlightOptions& options) {
  const double angle = 2.0 * std::numbers::pi * k / count;
  const Eigen::Vector3d centre(50.0 * std::cos(angle), 50.0 * std::sin(angle), 1.0);
  const Eigen::Vector3d z = (Eigen::Vector3d(0, 0, 20) - centre).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Receiver receiver;
  receiver.id = k;
  receiver.camera = Camera{2000, 2000, 900.0, 900.0, 999.5, 999.5, BrownConrady{}, 0.02};
  receiver.T_world_receiver.linear() << x, z.cross(x), z;
  receiver.T_world_receiver.translation() = centre;
  receiver.clock.offset_s = 0.3 * k;
  receiver.clock.covariance(0, 0) = options.clock_sigma_s * options.clock_sigma_s;
  Matrix6d P = Matrix6d::Zero();
  P(3, 3) = P(4, 4) = options.turn_sigma_rad * options.turn_sigma_rad;
  receiver.pose_covariance = P;
  receiver.sigma = options.noise_px;
  return receiver;
}

// The frame at `time` by the middle row's; its row's own moment is found in two rounds.
std::optional<ReceiverReading> look(const Receiver& receiver, double t_s) {
  double row_s = 0.0;
  std::optional<ReceiverReading> seen;
  for (int round = 0; round < 3; ++round) {
    seen = reading_of(receiver, simulated_position(t_s + row_s), Timestamp(from_seconds(t_s)));
    if (!seen) return std::nullopt;
    row_s = receiver.camera->readout_s * ((seen->value.y() + 0.5) / receiver.camera->height - 0.5);
  }
  return seen;
}

}  // namespace

Eigen::Vector3d simulated_position(double t_s) {
  return {15.0 * std::sin(0.31 * t_s), 12.0 * std::cos(0.4 * t_s), 20.0 + 5.0 * std::sin(0.23 * t_s)};
}

SimulatedFlight simulate_flight(const SimulatedFlightOptions& options) {
  std::mt19937 random(options.seed);
  std::normal_distribution<double> noise(0.0, options.noise_px);
  SimulatedFlight flight;
  for (int k = 0; k < options.receivers; ++k) {
    const auto i = static_cast<std::size_t>(k);
    flight.receivers.push_back(receiver_in_circle(k, options.receivers, options));
    Receiver truly = flight.receivers.back();
    if (i < options.clock_errors_s.size()) truly.clock.offset_s += options.clock_errors_s[i];
    if (i < options.turns_rad.size()) {
      Vector6d xi = Vector6d::Zero();
      xi.segment<2>(3) = options.turns_rad[i];
      truly.T_world_receiver = truly.T_world_receiver * perturbation(xi);
    }
    for (double t = 0.011 * k; t < options.duration_s; t += 1.0 / kRate_hz) {
      auto reading = look(truly, t);
      if (!reading) continue;
      reading->value += Eigen::Vector2d(noise(random), noise(random));
      flight.readings.push_back(*reading);
    }
  }
  return flight;
}

}  // namespace alidade::test
