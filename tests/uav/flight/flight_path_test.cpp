// SPDX-License-Identifier: Apache-2.0
#include "uav/flight/flight_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/support/simulated_flight.h"

namespace alidade {
namespace {

struct Score {
  double rms_m = 0.0;
  double nees = 0.0;  // per coordinate
};

Score score_of(const FlightPath& path, double begin_s, double end_s) {
  Score score;
  int count = 0;
  for (const FlightStep& step : path.steps) {
    const double t = to_seconds(step.state.time - Timestamp{});
    if (t < begin_s || t > end_s) continue;
    const Eigen::Vector3d error = step.state.p_world - test::simulated_position(t);
    const Eigen::Matrix3d P = step.state.covariance.topLeftCorner<3, 3>();
    score.rms_m += error.squaredNorm();
    score.nees += error.dot(P.inverse() * error) / 3.0;
    ++count;
  }
  score.rms_m = std::sqrt(score.rms_m / count);
  score.nees /= count;
  return score;
}

TEST(FlightPath, IsPreciseAndHonestWithReceiversAsStated) {
  const auto flight = test::simulate_flight({});
  const auto path =
      estimate_flight(flight.receivers, bearings_of(flight.receivers, flight.readings), {.correlation_s = 0.01});
  ASSERT_TRUE(path);
  const Score score = score_of(*path, 1.0, 29.0);
  EXPECT_LT(score.rms_m, 0.03);  // 0.5 px is 28 mm at 50 m, of one frame
  EXPECT_GT(score.nees, 0.3);
  EXPECT_LT(score.nees, 1.5);
}

TEST(FlightPath, FindsClocksThatAreOffWithoutTruth) {
  // Their mean is 0: what all share cannot be seen.
  const std::vector<double> errors{0.03, -0.05, 0.04, -0.02};
  const auto flight = test::simulate_flight({.clock_errors_s = errors, .clock_sigma_s = 0.05});
  const auto bearings = bearings_of(flight.receivers, flight.readings);
  const auto path = estimate_flight(flight.receivers, bearings, {.correlation_s = 0.01});
  ASSERT_TRUE(path);
  const FlightStep& middle = path->steps[path->steps.size() / 2];
  for (std::size_t k = 0; k < errors.size(); ++k) EXPECT_NEAR(middle.receivers[k].clock_s, errors[k], 0.005) << k;
  EXPECT_LT(score_of(*path, 1.0, 29.0).rms_m, 0.04);

  // Four clocks of 0.05 s: their mean, which nothing tells, is known to 0.025 s, and so is when the target is anywhere.
  EXPECT_GT(middle.receivers[0].clock_sigma_s, 0.0249);
  const Eigen::Vector3d v = middle.state.v_world, along = v.normalized();
  EXPECT_GT(along.dot(middle.state.covariance.topLeftCorner<3, 3>() * along), 0.99 * std::pow(0.025 * v.norm(), 2));

  auto sure = flight.receivers;
  for (Receiver& receiver : sure) receiver.clock.covariance.setZero();
  EXPECT_GT(score_of(*estimate_flight(sure, bearings), 1.0, 29.0).rms_m, 0.1);
}

TEST(FlightPath, StatesThePosesUncertaintyInItsCovariance) {
  const std::vector<Eigen::Vector2d> turns{{2e-3, -1e-3}, {-1e-3, 3e-3}, {1e-3, -2e-3}, {-3e-3, 1e-3}};
  const auto flight = test::simulate_flight({.turns_rad = turns, .turn_sigma_rad = 2e-3});
  const auto bearings = bearings_of(flight.receivers, flight.readings);
  const Score honest = score_of(*estimate_flight(flight.receivers, bearings), 1.0, 29.0);
  EXPECT_GT(honest.rms_m, 0.02);
  EXPECT_LT(honest.nees, 2.5);
  auto sure = flight.receivers;
  for (Receiver& receiver : sure) receiver.pose_covariance = Matrix6d::Zero();
  EXPECT_THROW(estimate_flight(sure, bearings), std::invalid_argument);
}

TEST(FlightPath, BearsWrongReadings) {
  auto flight = test::simulate_flight({});
  for (std::size_t i = 0; i < flight.readings.size(); i += 17) flight.readings[i].value.x() += 200.0;
  const auto path =
      estimate_flight(flight.receivers, bearings_of(flight.receivers, flight.readings), {.correlation_s = 0.01});
  ASSERT_TRUE(path);
  EXPECT_LT(score_of(*path, 1.0, 29.0).rms_m, 0.04);
}

TEST(FlightPath, SaysWhoSawTheTarget) {
  auto flight = test::simulate_flight({});
  std::erase_if(flight.readings, [](const ReceiverReading& r) {
    return r.receiver > 1 && r.time > Timestamp(from_seconds(15.0)) && r.time < Timestamp(from_seconds(20.0));
  });
  const auto path = estimate_flight(flight.receivers, bearings_of(flight.receivers, flight.readings));
  ASSERT_TRUE(path);
  EXPECT_EQ(step_at(*path, Timestamp(from_seconds(10.0)))->seen_by, 4);
  EXPECT_EQ(step_at(*path, Timestamp(from_seconds(18.0)))->seen_by, 2);
}

TEST(FlightPath, MovesItsNearestStep) {
  const auto flight = test::simulate_flight({});
  const auto path = estimate_flight(flight.receivers, bearings_of(flight.receivers, flight.readings));
  const auto state = state_at(*path, Timestamp(from_seconds(10.09)));
  ASSERT_TRUE(state);
  EXPECT_EQ(state->time, Timestamp(from_seconds(10.09)));
  EXPECT_LT((state->p_world - test::simulated_position(10.09)).norm(), 0.1);
  EXPECT_FALSE(state_at(*path, Timestamp(from_seconds(31.0))));
  EXPECT_FALSE(state_at(FlightPath{}, Timestamp{}));
}

TEST(FlightPath, IsEmptyWhereNoLinesMeet) {
  auto flight = test::simulate_flight({});
  std::erase_if(flight.readings, [](const ReceiverReading& r) { return r.receiver > 0; });
  EXPECT_FALSE(estimate_flight(flight.receivers, bearings_of(flight.receivers, flight.readings)));
  EXPECT_FALSE(estimate_flight(flight.receivers, {}));
}

TEST(FlightPath, RefusesWhatIsNoFlight) {
  auto flight = test::simulate_flight({.duration_s = 1.0});
  auto bearings = bearings_of(flight.receivers, flight.readings);
  EXPECT_THROW(estimate_flight(std::span(flight.receivers).first(1), bearings), std::invalid_argument);
  EXPECT_THROW(estimate_flight(flight.receivers, bearings, {.step_s = 0.0}), std::invalid_argument);
  std::swap(bearings.front(), bearings.back());
  EXPECT_THROW(estimate_flight(flight.receivers, bearings), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
