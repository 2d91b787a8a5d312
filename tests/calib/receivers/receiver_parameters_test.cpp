// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/receiver_parameters.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/simulated_flight.h"

namespace alidade {
namespace {

struct Case {
  Receiver receiver;
  ReceiverReading reading;
  ReceiverChange change;
};

// Something that flies straight on, so that a sight's derivative by time is exact.
TrackPoint straight(double t_s) {
  return {Eigen::Vector3d(3.0, -2.0, 18.0) + t_s * Eigen::Vector3d(2.0, 5.0, -1.0), Eigen::Vector3d(2.0, 5.0, -1.0)};
}

Case some_case() {
  auto flight = test::simulate_flight({.duration_s = 2.0});
  Case c{flight.receivers[1], {}, {}};
  c.receiver.camera->distortion = BrownConrady{-0.1, 0.02, 1e-3, -1e-3, 0.01};
  c.reading.receiver = 1;
  c.reading.time = Timestamp(from_seconds(1.0));
  c.reading.value = {1100.0, 400.0};
  c.change << 0.3, -0.2, 0.1, 0.05, -0.1, 0.2, 0.04, 1e-4, 0.003, 0.02;
  return c;
}

TEST(SightResidual, HasTheDerivativesOfItself) {
  const Case c = some_case();
  const auto residual = [&](const ReceiverChange& change) {
    const double t = sight_time(c.receiver, change, c.reading).t_s;
    return sight_residual(c.receiver, change, c.reading, straight(t))->residual_px;
  };
  const double t = sight_time(c.receiver, c.change, c.reading).t_s;
  const auto r = sight_residual(c.receiver, c.change, c.reading, straight(t));
  ASSERT_TRUE(r);
  for (int i = 0; i < kReceiverParameters; ++i) {
    ReceiverChange up = c.change, down = c.change;
    up[i] += 1e-6;
    down[i] -= 1e-6;
    const Eigen::Vector2d slope = (residual(up) - residual(down)) / 2e-6;
    EXPECT_LT((r->J_change.col(i) - slope).norm(), 1e-5 * (1.0 + slope.norm())) << i;
  }
  for (int i = 0; i < 3; ++i) {
    TrackPoint up = straight(t), down = straight(t);
    up.p_world[i] += 1e-5;
    down.p_world[i] -= 1e-5;
    const Eigen::Vector2d slope = (sight_residual(c.receiver, c.change, c.reading, up)->residual_px -
                                   sight_residual(c.receiver, c.change, c.reading, down)->residual_px) /
                                  2e-5;
    EXPECT_LT((r->J_position.col(i) - slope).norm(), 1e-5 * (1.0 + slope.norm())) << i;
  }
}

TEST(SightResidual, IsThatOfTheChangedReceiver) {
  const Case c = some_case();
  const Receiver after = changed(c.receiver, c.change);
  const double t = sight_time(c.receiver, c.change, c.reading).t_s;
  EXPECT_NEAR(t, sight_time(after, ReceiverChange::Zero(), c.reading).t_s, 1e-9);
  EXPECT_NEAR(t, to_seconds(bearing_of(after, c.reading)->time - Timestamp{}), 1e-8);
  const auto a = sight_residual(c.receiver, c.change, c.reading, straight(t));
  const auto b = sight_residual(after, ReceiverChange::Zero(), c.reading, straight(t));
  EXPECT_LT((a->residual_px - b->residual_px).norm(), 1e-9);
}

TEST(SightResidual, IsEmptyBehindTheCamera) {
  Case c = some_case();
  EXPECT_FALSE(sight_residual(c.receiver, ReceiverChange::Zero(), c.reading, {Eigen::Vector3d(0, 500, 0), {}}));
  c.receiver.camera.reset();
  EXPECT_THROW(sight_residual(c.receiver, c.change, c.reading, straight(0)), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
