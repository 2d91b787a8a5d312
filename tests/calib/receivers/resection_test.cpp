// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/resection.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/calib/receivers/simulated_track.h"
#include "tests/support/simulated_flight.h"

namespace alidade {
namespace {

constexpr double kDuration_s = 200.0;

KnownTrack true_track() {
  return test::simulated_track(kDuration_s);
}

std::vector<ReceiverReading> readings_of(const test::SimulatedFlight& flight, int receiver) {
  std::vector<ReceiverReading> own;
  for (const ReceiverReading& reading : flight.readings) {
    if (reading.receiver == receiver) own.push_back(reading);
  }
  return own;
}

TEST(Resection, FindsAReceiverFromNextToNothing) {
  const auto flight = test::simulate_flight({.receivers = 2, .duration_s = kDuration_s});
  const Receiver truth = flight.receivers[1];
  Receiver given = truth;
  given.T_world_receiver = Eigen::Isometry3d::Identity();
  given.clock = {};
  given.camera->readout_s = 0.0;
  const auto found = resect_receiver(given, readings_of(flight, 1), true_track(), {.search_s = 3.0});
  ASSERT_TRUE(found);
  const Vector6d off = difference(truth.T_world_receiver, found->receiver.T_world_receiver);
  EXPECT_LT(off.head<3>().norm(), 0.05);
  EXPECT_LT(off.tail<3>().norm(), 1e-3);
  const Timestamp own(from_seconds(100.0));
  EXPECT_NEAR(to_seconds(common_time(found->receiver.clock, own) - common_time(truth.clock, own)), 0.0, 2e-3);
  EXPECT_NEAR(found->receiver.clock.rate, 0.0, 2e-5);
  EXPECT_NEAR(found->receiver.camera->readout_s, 0.02, 0.01);
  EXPECT_NEAR(found->receiver.sigma, 0.5, 0.05);
}

TEST(Resection, IsAsSureAsItSays) {
  const KnownTrack track = true_track();
  double chi2 = 0.0;
  constexpr int kRuns = 12;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    const auto flight = test::simulate_flight({.receivers = 1, .duration_s = kDuration_s, .seed = seed});
    const auto found = resect_receiver(flight.receivers[0], readings_of(flight, 0), track, {.keep_pose = true});
    ASSERT_TRUE(found);
    const Vector6d off = difference(flight.receivers[0].T_world_receiver, found->receiver.T_world_receiver);
    chi2 += off.dot(found->receiver.pose_covariance->inverse() * off) / 6.0 / kRuns;
  }
  // Twenty blocks tell ten variances to a third each; what is unexplained is counted in, so below 1 is usual.
  EXPECT_GT(chi2, 0.2);
  EXPECT_LT(chi2, 2.0);
}

TEST(Resection, BearsWrongReadingsAndFindsAFocalLength) {
  const auto flight = test::simulate_flight({.receivers = 1, .duration_s = kDuration_s});
  auto readings = readings_of(flight, 0);
  for (std::size_t i = 0; i < readings.size(); i += 9) readings[i].value.y() += 150.0;
  Receiver given = flight.receivers[0];
  given.camera->fx *= 1.03;
  given.camera->fy *= 1.03;
  const auto found = resect_receiver(given, readings, true_track(), {.find_focal = true});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->focal_scale, 1.0 / 1.03, 2e-3);
  EXPECT_LT(difference(flight.receivers[0].T_world_receiver, found->receiver.T_world_receiver).head<3>().norm(), 0.1);
}

TEST(Resection, CountsWhatItCannotExplain) {
  auto flight = test::simulate_flight({.receivers = 1, .duration_s = kDuration_s});
  for (ReceiverReading& reading : flight.readings) {
    reading.value.x() += 8.0 * std::sin(0.05 * to_seconds(reading.time - Timestamp{}));
  }
  const auto found = resect_receiver(flight.receivers[0], flight.readings, true_track(), {.keep_pose = true});
  ASSERT_TRUE(found);
  EXPECT_GT(found->wander_px, 2.0);  // a sine of 8 px is 4 px RMS in the mean of two coordinates
  EXPECT_LT(found->wander_px, 5.0);
  EXPECT_GT((*found->receiver.pose_covariance)(3, 3), std::pow(2.0 / 900.0, 2));
}

TEST(Resection, LeavesWhatStands) {
  const auto flight = test::simulate_flight({.receivers = 1, .duration_s = kDuration_s});
  const auto found = resect_receiver(flight.receivers[0], flight.readings, true_track(),
                                     {.keep_pose = true, .find_place = false, .find_rate = false});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->receiver.T_world_receiver.translation(), flight.receivers[0].T_world_receiver.translation());
  EXPECT_EQ(found->receiver.clock.rate, 0.0);
  EXPECT_EQ(found->focal_scale, 1.0);
  EXPECT_EQ(found->sigma[kTranslation], 0.0);
  EXPECT_GT(found->sigma[kRotation], 0.0);
}

TEST(Resection, IsEmptyWithTooFewReadings) {
  const auto flight = test::simulate_flight({.receivers = 2, .duration_s = 3.0});
  EXPECT_FALSE(resect_receiver(flight.receivers[0], readings_of(flight, 0), true_track(), {.keep_pose = true}));
  EXPECT_THROW(resect_receiver(flight.receivers[0], readings_of(flight, 1), true_track()), std::invalid_argument);
  EXPECT_THROW(resect_receiver(flight.receivers[0], {}, true_track(), {.block_s = 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
