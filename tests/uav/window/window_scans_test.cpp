// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_scans.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using namespace std::chrono_literals;

Bearing seen(int receiver, Timestamp time) {
  Bearing bearing;
  bearing.receiver = receiver;
  bearing.time = time;
  bearing.covariance = 1e-6 * Eigen::Matrix2d::Identity();
  return bearing;
}

TEST(WindowScans, AreWhatAReceiverSawInAPeriod) {
  const std::vector<Bearing> bearings{seen(1, Timestamp(5000ms)), seen(2, Timestamp(5100ms)),
                                      seen(1, Timestamp(5400ms)), seen(1, Timestamp(6000ms))};
  const BearingWindow window = prepare_window(bearings, {});
  ASSERT_EQ(window.scans.size(), 3u);
  EXPECT_EQ(window.scan_of[0], window.scan_of[2]);
  EXPECT_NE(window.scan_of[0], window.scan_of[1]);
  EXPECT_NE(window.scan_of[0], window.scan_of[3]);
  EXPECT_LE(window.scans[0].t_s, window.scans[1].t_s);
  EXPECT_LE(window.scans[1].t_s, window.scans[2].t_s);
  EXPECT_NEAR(window.end_s - window.begin_s, 1.0, 1e-12);
}

TEST(WindowScans, AreFramesWithoutAPeriod) {
  const std::vector<Bearing> bearings{seen(1, Timestamp(5000ms)), seen(1, Timestamp(5000ms)),
                                      seen(1, Timestamp(5001ms))};
  WindowOptions options;
  options.period_s = 0.0;
  const BearingWindow window = prepare_window(bearings, options);
  ASSERT_EQ(window.scans.size(), 2u);
  EXPECT_EQ(window.scans[0].bearings.size(), 2u);
}

// Pd / (density of false bearings × 2π σ²)
TEST(WindowScans, WeighABearingAgainstFalseOnes) {
  const BearingWindow window = prepare_window(std::vector{seen(1, Timestamp(1s))}, {});
  EXPECT_NEAR(window.log_gain[0], std::log(0.9 / (10.0 * 2.0 * std::numbers::pi * 1e-6)), 1e-9);
  EXPECT_NEAR(window.sigma_rad[0], 1e-3, 1e-12);
}

}  // namespace
}  // namespace alidade
