// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_residuals.h"

#include <gtest/gtest.h>

#include "tests/support/simulated_flight.h"

namespace alidade {
namespace {

PathLookup simulated(const Eigen::Vector3d& shift_m = Eigen::Vector3d::Zero()) {
  return [shift_m](double t_s) { return TrackPoint{test::simulated_position(t_s) + shift_m, Eigen::Vector3d::Zero()}; };
}

std::vector<ReceiverReading> of_first(const test::SimulatedFlight& flight) {
  std::vector<ReceiverReading> own;
  for (const auto& reading : flight.readings) {
    if (reading.receiver == 0) own.push_back(reading);
  }
  return own;
}

TEST(ReceiverResiduals, AreTheNoiseAboutTheTruePath) {
  const auto flight = test::simulate_flight({.receivers = 2, .duration_s = 20.0, .noise_px = 0.5});
  const auto readings = of_first(flight);
  const auto left = residuals_about(simulated(), flight.receivers[0], readings);
  EXPECT_EQ(left.readings, static_cast<std::int64_t>(readings.size()));
  ASSERT_TRUE(left.median_px);
  EXPECT_NEAR(*left.median_px, 0.5 * 1.17741, 0.06);  // Rayleigh; 400 of them: 6 standard deviations
  EXPECT_EQ(left.samples.size(), readings.size());
  EXPECT_EQ(left.samples[3].pixel, readings[3].value);
}

TEST(ReceiverResiduals, PointFromWhatWasReadToThePath) {
  const auto flight = test::simulate_flight({.receivers = 2, .duration_s = 5.0, .noise_px = 1e-6});
  const auto left = residuals_about(simulated({0, 0, 1.0}), flight.receivers[0], of_first(flight));
  for (const auto& sample : left.samples) EXPECT_LT(sample.residual_px.y(), -5.0);  // higher is further up the image
}

TEST(ReceiverResiduals, AreMissingWhereThePathIsUnknownOrBehind) {
  const auto flight = test::simulate_flight({.receivers = 2, .duration_s = 5.0});
  const PathLookup nowhere = [](double) { return std::optional<TrackPoint>(); };
  const auto none = residuals_about(nowhere, flight.receivers[0], of_first(flight));
  EXPECT_EQ(none.readings, 0);
  EXPECT_FALSE(none.median_px);
  const auto behind = residuals_about(simulated({500.0, 0, 0}), flight.receivers[0], of_first(flight));
  EXPECT_GT(behind.readings, 0);
  EXPECT_FALSE(behind.median_px);
  EXPECT_TRUE(behind.samples.empty());
}

}  // namespace
}  // namespace alidade
