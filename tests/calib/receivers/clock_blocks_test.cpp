// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/clock_blocks.h"

#include <gtest/gtest.h>

#include "tests/calib/receivers/simulated_track.h"
#include "tests/support/simulated_flight.h"

namespace alidade {
namespace {

constexpr double kDuration_s = 100.0;

TEST(ClockBlocks, TellWhenFramesWereDropped) {
  auto flight = test::simulate_flight({.receivers = 1, .duration_s = kDuration_s});
  for (ReceiverReading& reading : flight.readings) {
    if (reading.time > Timestamp(from_seconds(60.0))) reading.time -= from_seconds(0.25);
  }
  const auto blocks = clock_blocks(flight.receivers[0], flight.readings, test::simulated_track(kDuration_s));
  ASSERT_GE(blocks.size(), 4u);
  for (const ClockBlock& block : blocks) {
    const double t = to_seconds(block.middle - Timestamp{});
    const double late_s = t < 60.0 ? 0.0 : 0.25;
    EXPECT_NEAR(block.late_s, late_s, 5.0 * block.sigma_s + 1e-3) << t;
    EXPECT_LT(block.sigma_s, 0.02);
  }
}

TEST(ClockBlocks, TellLateFromAskew) {
  auto flight = test::simulate_flight({.receivers = 1, .duration_s = kDuration_s});
  for (ReceiverReading& reading : flight.readings) reading.value += Eigen::Vector2d(6.0, -4.0);
  for (const auto& block : clock_blocks(flight.receivers[0], flight.readings, test::simulated_track(kDuration_s))) {
    EXPECT_NEAR(block.late_s, 0.0, 5.0 * block.sigma_s + 1e-3);
  }
}

TEST(ClockBlocks, LeaveOutWhatTellsNothing) {
  auto flight = test::simulate_flight({.receivers = 1, .duration_s = kDuration_s});
  EXPECT_TRUE(
      clock_blocks(flight.receivers[0], std::span(flight.readings).first(20), test::simulated_track(kDuration_s))
          .empty());
  // Something that stands still looks alike at all times.
  std::vector<TimedPosition> still;
  for (int i = 0; i < 600; ++i) still.push_back({Timestamp(from_seconds(0.2 * i)), test::simulated_position(0.0)});
  for (ReceiverReading& reading : flight.readings) reading.value = flight.readings[0].value;
  EXPECT_TRUE(clock_blocks(flight.receivers[0], flight.readings, KnownTrack(still)).empty());
}

}  // namespace
}  // namespace alidade
