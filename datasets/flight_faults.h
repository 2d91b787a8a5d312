// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "camera/measurement.h"
#include "camera/receiver.h"

namespace alidade {

// What goes wrong with receivers in the field, put into a recording on purpose. Indices are places among the receivers.

/// Two receivers written down in each other's places; their directions stay.
std::vector<Receiver> with_swapped_places(std::vector<Receiver> receivers, std::size_t a, std::size_t b);

/// A camera's focal lengths times `factor`.
std::vector<Receiver> with_focal_scaled(std::vector<Receiver> receivers, std::size_t which, double factor);

/// Readings of a camera that counts on as if nothing were while it drops `lost_s` of frames every `every_s` of its own
/// clock: what it reads later bears earlier times.
std::vector<ReceiverReading> with_dropped_frames(std::vector<ReceiverReading> readings, int receiver, double lost_s,
                                                 double every_s);

/// How far a start is off: expected lengths for places and turns, standard deviation for clocks.
struct Disturbance {
  double place_m = 1.0;
  double turn_rad = 0.01;
  double clock_s = 0.1;
  int time_receiver = 0;  ///< id of the one whose clock stays: it is the common time
  unsigned seed = 1;
};
std::vector<Receiver> disturbed(std::vector<Receiver> receivers, const Disturbance& disturbance);

/// One reading per receiver and epoch: of each receiver the one nearest to the epoch plus delays_s[place among the
/// receivers, repeated where there are more], by the receivers' clocks; none farther than `within_s`. In order of
/// epochs, then of receivers.
struct EpochReading {
  std::size_t epoch = 0;
  ReceiverReading reading;
};
std::vector<EpochReading> epoch_readings(std::span<const Receiver> receivers, std::span<const ReceiverReading> readings,
                                         std::span<const Timestamp> epochs, std::span<const double> delays_s,
                                         double within_s);

}  // namespace alidade
