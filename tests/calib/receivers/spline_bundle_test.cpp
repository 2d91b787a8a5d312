// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/spline_bundle.h"

#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "geometry/alignment.h"
#include "tests/support/simulated_flight.h"

namespace alidade {
namespace {

constexpr double kDuration_s = 60.0;

// Root mean square distance from the true path once laid over it, m.
double aligned_rms(const SplinePath& path) {
  std::vector<Eigen::Vector3d> estimate, truth;
  for (double t = 1.0; t < kDuration_s - 1.0; t += 0.2) {
    estimate.push_back(path.at(t)->p_world);
    truth.push_back(test::simulated_position(t));
  }
  const auto T = align_points(estimate, truth, AlignmentKind::Similarity);
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) sum += (*T * estimate[i] - truth[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

// Places off by a metre, directions by 0.01 rad, all clocks but the first by 0.1 s, focal lengths by 1 %.
std::vector<Receiver> disturbed(std::vector<Receiver> receivers, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (Receiver& receiver : receivers) {
    Vector6d xi;
    for (int i = 0; i < 6; ++i) xi[i] = normal(random) * (i < 3 ? 1.0 : 0.01) / std::sqrt(3.0);
    receiver.T_world_receiver = receiver.T_world_receiver * perturbation(xi);
    if (receiver.id > 0) receiver.clock.offset_s += 0.1 * normal(random);
    const double focal = 1.0 + 0.01 * normal(random);
    receiver.camera->fx *= focal;
    receiver.camera->fy *= focal;
  }
  return receivers;
}

TEST(SplineBundle, FindsPathPosesAndClocksWithoutTruth) {
  const auto flight = test::simulate_flight({.receivers = 5, .duration_s = kDuration_s});
  const auto start = disturbed(flight.receivers, 3);
  const auto bundle = bundle_flight(start, flight.readings);
  ASSERT_TRUE(bundle);
  EXPECT_LT(aligned_rms(bundle->path), 0.03);
  for (std::size_t k = 0; k < start.size(); ++k) {
    EXPECT_NEAR(bundle->receivers[k].clock.offset_s, flight.receivers[k].clock.offset_s, 3e-3) << k;
    EXPECT_NEAR(bundle->receivers[k].camera->fx, 900.0, 9.0) << k;
    EXPECT_LT(bundle->receivers[k].sigma, 0.7) << k;
  }
  EXPECT_EQ(bundle->receivers[0].clock.offset_s, start[0].clock.offset_s);
}

TEST(SplineBundle, EndsAtTheSamePathFromADisturbedStart) {
  const auto flight = test::simulate_flight({.duration_s = kDuration_s});
  const double undisturbed = aligned_rms(bundle_flight(flight.receivers, flight.readings)->path);
  for (const unsigned seed : {1u, 2u, 3u}) {
    EXPECT_LT(aligned_rms(bundle_flight(disturbed(flight.receivers, seed), flight.readings)->path), 1.15 * undisturbed);
  }
}

TEST(SplineBundle, BearsWrongReadings) {
  auto flight = test::simulate_flight({.duration_s = kDuration_s});
  for (std::size_t i = 0; i < flight.readings.size(); i += 13) flight.readings[i].value.x() += 80.0;
  EXPECT_LT(aligned_rms(bundle_flight(flight.receivers, flight.readings)->path), 0.03);
}

TEST(SplineBundle, HoldsWhatStands) {
  const auto flight = test::simulate_flight({.duration_s = 20.0});
  const auto bundle = bundle_flight(flight.receivers, flight.readings, {.focal_sigma = 0.0, .time_receiver = 2});
  ASSERT_TRUE(bundle);
  for (const ReceiverChange& change : bundle->changes) {
    EXPECT_EQ(change[kFocal], 0.0);
    EXPECT_EQ(change[kReadout], 0.0);
  }
  EXPECT_EQ(bundle->changes[2][kClockOffset], 0.0);
  EXPECT_NE(bundle->changes[0][kClockOffset], 0.0);
}

TEST(SplineBundle, RefusesWhatIsNoFlight) {
  auto flight = test::simulate_flight({.duration_s = 2.0});
  EXPECT_FALSE(bundle_flight(flight.receivers, {}));
  EXPECT_THROW(bundle_flight(std::span(flight.receivers).first(1), flight.readings), std::invalid_argument);
  EXPECT_THROW(bundle_flight(std::span(flight.receivers).first(2), flight.readings), std::invalid_argument);
  EXPECT_THROW(bundle_flight(flight.receivers, flight.readings, {.time_receiver = 9}), std::invalid_argument);
  EXPECT_THROW(bundle_flight(flight.receivers, flight.readings, {.jerk_m_s3 = 0.0}), std::invalid_argument);
  flight.receivers[1].camera.reset();
  EXPECT_THROW(bundle_flight(flight.receivers, flight.readings), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
