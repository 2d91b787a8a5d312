// SPDX-License-Identifier: Apache-2.0
#include "uav/flight/flight_model.h"

#include <gtest/gtest.h>

#include "geometry/tangent.h"
#include "tests/support/simulated_flight.h"

namespace alidade {
namespace {

FlightBearing some_bearing(const Receiver& receiver) {
  ReceiverReading reading;
  reading.receiver = receiver.id;
  reading.time = own_time(receiver.clock, Timestamp(from_seconds(1.03)));
  reading.value = {1210.0, 830.0};
  return {*bearing_of(receiver, reading), receiver.id, 0.5};
}

TEST(FlightSystem, HasTheDerivativesOfItsOwnErrors) {
  const auto flight = test::simulate_flight({.duration_s = 0.1});
  const auto drifts = receiver_drifts(flight.receivers, Timestamp{}, {});
  const std::vector<FlightBearing> bearings{some_bearing(flight.receivers[2])};
  Eigen::VectorXd x = Eigen::VectorXd::Zero(FlightLayout{4}.size());
  x.head<9>() << 1.0, -2.0, 19.0, 5.0, 3.0, -4.0, 1.0, 2.0, 0.5;
  x.segment<2>(FlightLayout::turn_at(2)) << 0.01, -0.02;
  x[FlightLayout::clock_at(2)] = 0.02;
  // With no loss of weight the gradient at `about` is Jᵀ W e.
  const auto gradient = [&](const Eigen::VectorXd& about) {
    const FlightSystem s = flight_system(bearings, drifts, {about, Timestamp(from_seconds(1.0)), 1e9, false});
    return Eigen::VectorXd(s.gradient + s.information * about);
  };
  const FlightSystem s = flight_system(bearings, drifts, {x, Timestamp(from_seconds(1.0)), 1e9, false});
  const auto cost = [&](const Eigen::VectorXd& about) {
    const Bearing& b = bearings[0].bearing;
    const double dt = to_seconds(b.time - Timestamp(from_seconds(1.0))) + about[FlightLayout::clock_at(2)];
    const Eigen::Vector3d p = about.head<3>() + dt * about.segment<3>(3) + 0.5 * dt * dt * about.segment<3>(6);
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    turn.head<2>() = about.segment<2>(FlightLayout::turn_at(2));
    // The receiver is truly turned by `turn`, so that what it saw lies there.
    const Eigen::Vector3d d = b.direction_world + (drifts[2].R_world_receiver * turn).cross(b.direction_world);
    const Eigen::Vector2d e = tangent_basis(b.direction_world).transpose() * ((p - b.origin_world).normalized() - d);
    return 0.5 * e.dot((b.covariance / bearings[0].share).inverse() * e);
  };
  const Eigen::VectorXd g = gradient(x);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double h = i < 9 ? 1e-5 : 1e-7;
    Eigen::VectorXd up = x, down = x;
    up[i] += h;
    down[i] -= h;
    const double slope = (cost(up) - cost(down)) / (2.0 * h);
    EXPECT_NEAR(g[i], slope, 1e-5 * (1.0 + std::abs(slope))) << i;
  }
  EXPECT_TRUE(s.information.isApprox(s.information.transpose(), 1e-12));
}

TEST(FlightSystem, CountsWhatIsFarOffLess) {
  const auto flight = test::simulate_flight({.duration_s = 0.1});
  const auto drifts = receiver_drifts(flight.receivers, Timestamp{}, {});
  const std::vector<FlightBearing> bearings{some_bearing(flight.receivers[2])};
  Eigen::VectorXd x = Eigen::VectorXd::Zero(FlightLayout{4}.size());
  x.head<3>() << 30.0, -20.0, 19.0;
  const auto full = flight_system(bearings, drifts, {x, Timestamp(from_seconds(1.0)), 1e9, false});
  const auto less = flight_system(bearings, drifts, {x, Timestamp(from_seconds(1.0)), 3.0, false});
  EXPECT_LT(less.information.trace(), 1e-3 * full.information.trace());
}

TEST(FlightTransition, KeepsStationaryWhatIsStationary) {
  const auto flight = test::simulate_flight({.duration_s = 0.1, .turn_sigma_rad = 2e-3});
  const FlightPathOptions options;
  const auto drifts = receiver_drifts(flight.receivers, Timestamp{}, options);
  const FlightTransition t = flight_transition(drifts, options);
  const Eigen::MatrixXd P = flight_prior(drifts, options);
  const Eigen::MatrixXd next = t.F * P * t.F.transpose() + t.Q;
  const int turn = FlightLayout::turn_at(1);
  EXPECT_NEAR(next(turn, turn), 4e-6, 1e-12);
  EXPECT_NEAR(next(6, 6), P(6, 6), 1e-9);
}

TEST(CommonTime, IsHeldByTheClocksThatAreKnownBest) {
  std::vector<ReceiverDrift> drifts(2);
  drifts[0].clock_s = 0.003;
  drifts[1].clock_s = 0.004;
  CommonTime common = common_time_of(drifts, 100.0);
  EXPECT_NEAR(common.weights[FlightLayout::clock_at(0)], 0.64, 1e-12);
  EXPECT_NEAR(common.weights.sum(), 1.0, 1e-12);
  EXPECT_NEAR(common.sigma_s, 0.0024, 1e-12);
  drifts[0].clock_walk_s = 0.01;  // at half-way 0.07 s
  common = common_time_of(drifts, 100.0);
  EXPECT_GT(common.weights[FlightLayout::clock_at(1)], 0.99);
}

TEST(ReceiverDrifts, ComeFromTheStatedCovariances) {
  auto receivers = test::simulate_flight({.duration_s = 0.1}).receivers;
  receivers[0].pose_covariance = Matrix6d(Vector6d(0.36, 0.36, 9, 1e-6, 1e-6, 1).asDiagonal());
  receivers[0].clock.covariance << 1e-6, 0, 0, 1e-10;
  receivers[1].pose_covariance.reset();
  const auto drifts = receiver_drifts(receivers, Timestamp(from_seconds(100.0)), {});
  EXPECT_NEAR(drifts[0].turn_rad, std::sqrt(1e-6 + 0.36 / 3600.0), 1e-9);
  EXPECT_NEAR(drifts[0].clock_s, std::sqrt(2e-6), 1e-6);
  EXPECT_NEAR(drifts[0].clock_walk_s, std::sqrt(3e-8), 1e-9);
  EXPECT_EQ(drifts[1].turn_rad, FlightPathOptions{}.turn_rad);
}

}  // namespace
}  // namespace alidade
