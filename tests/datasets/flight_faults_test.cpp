// SPDX-License-Identifier: Apache-2.0
#include "datasets/flight_faults.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::vector<Receiver> three() {
  std::vector<Receiver> receivers(3);
  for (int k = 0; k < 3; ++k) {
    Receiver& receiver = receivers[static_cast<std::size_t>(k)];
    receiver.id = k;
    receiver.camera = Camera{1000, 1000, 800.0, 810.0, 500.0, 500.0, BrownConrady{}, 0.0};
    receiver.T_world_receiver.translation() = Eigen::Vector3d(k, 2.0 * k, 0.0);
    receiver.clock.offset_s = k;
  }
  return receivers;
}

ReceiverReading reading(int receiver, double t_s) {
  ReceiverReading r;
  r.receiver = receiver;
  r.time = Timestamp(from_seconds(t_s));
  return r;
}

TEST(FlightFaults, SwapPlacesAlone) {
  const auto swapped = with_swapped_places(three(), 0, 2);
  EXPECT_EQ(swapped[0].T_world_receiver.translation(), Eigen::Vector3d(2, 4, 0));
  EXPECT_EQ(swapped[2].T_world_receiver.translation(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(swapped[0].clock.offset_s, 0.0);
  EXPECT_THROW(with_swapped_places(three(), 0, 3), std::out_of_range);
}

TEST(FlightFaults, ScaleFocalLengths) {
  const auto scaled = with_focal_scaled(three(), 1, 1.03);
  EXPECT_DOUBLE_EQ(scaled[1].camera->fx, 824.0);
  EXPECT_DOUBLE_EQ(scaled[1].camera->fy, 834.3);
  EXPECT_EQ(scaled[0].camera->fx, 800.0);
}

TEST(FlightFaults, DropFramesOfOneReceiver) {
  const auto dropped = with_dropped_frames({reading(0, 50.0), reading(1, 50.0), reading(1, 130.0)}, 1, 0.2, 60.0);
  EXPECT_EQ(dropped[0].time, Timestamp(from_seconds(50.0)));
  EXPECT_EQ(dropped[1].time, Timestamp(from_seconds(50.0)));
  EXPECT_EQ(dropped[2].time, Timestamp(from_seconds(129.6)));
}

TEST(FlightFaults, DisturbAllButTheCommonTime) {
  const auto start = disturbed(three(), {.time_receiver = 1, .seed = 4});
  EXPECT_EQ(start[1].clock.offset_s, 1.0);
  EXPECT_NE(start[0].clock.offset_s, 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    const double off_m = difference(three()[k].T_world_receiver, start[k].T_world_receiver).head<3>().norm();
    EXPECT_GT(off_m, 0.1);
    EXPECT_LT(off_m, 4.0);
  }
}

TEST(EpochReadings, AreTheNearestToTheDelayedEpoch) {
  const auto receivers = three();
  // Of receiver 0 at 0, 0.1, ...; of receiver 1 the same moments by its own clock, which is a second early.
  std::vector<ReceiverReading> readings;
  for (int i = 0; i < 30; ++i) readings.push_back(reading(0, 0.1 * i));
  for (int i = 0; i < 30; ++i) readings.push_back(reading(1, 0.1 * i - 1.0));
  const std::vector<Timestamp> epochs{Timestamp(from_seconds(1.0)), Timestamp(from_seconds(2.0)),
                                      Timestamp(from_seconds(9.0))};
  const std::vector<double> delays_s{0.0, 0.26};
  const auto chosen = epoch_readings(receivers, readings, epochs, delays_s, 0.1);
  ASSERT_EQ(chosen.size(), 4u);
  EXPECT_EQ(chosen[0].epoch, 0u);
  EXPECT_EQ(chosen[0].reading.time, Timestamp(from_seconds(1.0)));
  EXPECT_EQ(chosen[1].reading.receiver, 1);
  EXPECT_EQ(chosen[1].reading.time, Timestamp(from_seconds(0.3)));
  EXPECT_EQ(chosen[3].epoch, 1u);
}

}  // namespace
}  // namespace alidade
