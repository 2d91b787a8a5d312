// SPDX-License-Identifier: Apache-2.0
#include "uav/flight/receiver_clocks.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

Timestamp at(double s) {
  return Timestamp(from_seconds(s));
}

// Clock 0 gains 2 ms in 10 s beyond what is believed, clock 1 is 5 ms late all the time.
FlightPath path_of_two() {
  FlightPath path;
  for (int i = 0; i <= 50; ++i) {
    FlightStep step;
    step.state.time = at(100.0 + 0.2 * i);
    step.receivers = {{Eigen::Vector2d::Zero(), 2e-4 * 0.2 * i, 1e-3}, {Eigen::Vector2d::Zero(), 5e-3, 1e-3}};
    path.steps.push_back(step);
  }
  return path;
}

std::vector<Receiver> two_receivers() {
  std::vector<Receiver> receivers(2);
  receivers[0].id = 0;
  receivers[0].clock.offset_s = 30.0;
  receivers[0].clock.rate = 1e-5;
  receivers[1].id = 1;
  return receivers;
}

TEST(ClocksInOperation, AddWhatTheFlightShowed) {
  const auto receivers = two_receivers();
  const auto clocks = clocks_in_operation(receivers, path_of_two(), at(100.0), at(110.0));
  for (const double t : {100.0, 104.0, 110.0}) {
    const Timestamp own = own_time(receivers[0].clock, at(t));
    EXPECT_NEAR(to_seconds(common_time(clocks[0], own) - at(t)), 2e-4 * (t - 100.0), 1e-7) << t;
    EXPECT_NEAR(to_seconds(common_time(clocks[1], at(t)) - at(t)), 5e-3, 1e-9) << t;
  }
  EXPECT_NEAR(std::sqrt(clocks[1].covariance(0, 0)), 1e-3, 1e-9);
}

TEST(ClocksInOperation, AreOfTheTimeAskedForAlone) {
  auto path = path_of_two();
  for (std::size_t i = 0; i < 25; ++i) path.steps[i].receivers[1].clock_s = 1.0;
  const auto clocks = clocks_in_operation(two_receivers(), path, at(105.0), at(110.0));
  EXPECT_NEAR(to_seconds(common_time(clocks[1], at(107.0)) - at(107.0)), 5e-3, 1e-9);
}

TEST(ClocksInOperation, RefuseAnEmptyTimeAndOtherReceivers) {
  const auto receivers = two_receivers();
  EXPECT_THROW(clocks_in_operation(receivers, path_of_two(), at(0.0), at(10.0)), std::invalid_argument);
  EXPECT_THROW(clocks_in_operation(std::span(receivers).first(1), path_of_two(), at(100.0), at(110.0)),
               std::invalid_argument);
}

}  // namespace
}  // namespace alidade
