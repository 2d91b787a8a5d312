// SPDX-License-Identifier: Apache-2.0
#include "datasets/flight_faults.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "camera/rolling_shutter.h"

namespace alidade {

std::vector<Receiver> with_swapped_places(std::vector<Receiver> receivers, std::size_t a, std::size_t b) {
  const Eigen::Vector3d place = receivers.at(a).T_world_receiver.translation();
  receivers[a].T_world_receiver.translation() = receivers.at(b).T_world_receiver.translation();
  receivers[b].T_world_receiver.translation() = place;
  return receivers;
}

std::vector<Receiver> with_focal_scaled(std::vector<Receiver> receivers, std::size_t which, double factor) {
  receivers.at(which).camera.value().fx *= factor;
  receivers[which].camera->fy *= factor;
  return receivers;
}

std::vector<ReceiverReading> with_dropped_frames(std::vector<ReceiverReading> readings, int receiver, double lost_s,
                                                 double every_s) {
  for (ReceiverReading& reading : readings) {
    if (reading.receiver != receiver) continue;
    reading.time -= from_seconds(lost_s * std::floor(to_seconds(reading.time - Timestamp{}) / every_s));
  }
  return readings;
}

std::vector<Receiver> disturbed(std::vector<Receiver> receivers, const Disturbance& disturbance) {
  std::mt19937 random(disturbance.seed);
  std::normal_distribution<double> normal;
  for (Receiver& receiver : receivers) {
    Vector6d xi;
    for (int i = 0; i < 6; ++i) {
      xi[i] = normal(random) * (i < 3 ? disturbance.place_m : disturbance.turn_rad) / std::sqrt(3.0);
    }
    receiver.T_world_receiver = receiver.T_world_receiver * perturbation(xi);
    const double clock_s = disturbance.clock_s * normal(random);
    if (receiver.id != disturbance.time_receiver) receiver.clock.offset_s += clock_s;
  }
  return receivers;
}

std::vector<EpochReading> epoch_readings(std::span<const Receiver> receivers, std::span<const ReceiverReading> readings,
                                         std::span<const Timestamp> epochs, std::span<const double> delays_s,
                                         double within_s) {
  std::vector<EpochReading> chosen;
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    std::vector<std::pair<Timestamp, const ReceiverReading*>> own;
    for (const ReceiverReading& reading : readings) {
      if (reading.receiver != receivers[k].id) continue;
      Timestamp time = common_time(receivers[k].clock, reading.time);
      if (receivers[k].camera) time += from_seconds(row_time_s(*receivers[k].camera, reading.value.y()));
      own.emplace_back(time, &reading);
    }
    std::sort(own.begin(), own.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto delay = from_seconds(delays_s[k % delays_s.size()]);
    for (std::size_t i = 0; i < epochs.size(); ++i) {
      const Timestamp wanted = epochs[i] + delay;
      auto it =
          std::lower_bound(own.begin(), own.end(), wanted, [](const auto& a, Timestamp t) { return a.first < t; });
      if (it != own.begin() && (it == own.end() || wanted - (it - 1)->first < it->first - wanted)) --it;
      if (it == own.end() || std::chrono::abs(it->first - wanted) > from_seconds(within_s)) continue;
      chosen.push_back({i, *it->second});
    }
  }
  std::stable_sort(chosen.begin(), chosen.end(), [](const auto& a, const auto& b) { return a.epoch < b.epoch; });
  return chosen;
}

}  // namespace alidade
