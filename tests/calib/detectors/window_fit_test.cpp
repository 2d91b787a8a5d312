// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/window_fit.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "calib/detectors/placed_readings.h"
#include "geometry/pose.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

constexpr double kSigma = 3e-4;  // rad

// Two blocks of four detectors, 2 m away, at right angles to each other.
std::vector<LineDetector> two_blocks() {
  std::vector<LineDetector> detectors;
  for (int k = 0; k < 2; ++k) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = exp_so3({0, k * std::numbers::pi / 2, 0});
    T.translation() = -2.0 * T.linear().col(2);
    for (int i = 0; i < 4; ++i) {
      LineDetector d{4 * k + i, "block " + std::to_string(k), FocalLine{}};
      d.T_world_station = T;
      d.T_station_detector.linear() = exp_so3({0, 0, i * std::numbers::pi / 4});
      d.sigma = kSigma;
      detectors.push_back(d);
    }
  }
  return detectors;
}

RigidBody body() {
  return {"body", {{0, {0.15, 0.01, 0}}, {1, {-0.05, 0.14, 0.02}}, {2, {-0.06, -0.12, 0}}, {3, {0.01, 0, 0.16}}}};
}

// Shaken: 2 m/s, 10 rad/s, 50 m/s², 500 rad/s².
WindowMotion shaken() {
  WindowMotion m;
  m.time_s = 0.01;
  m.knot.p_world = {0.1, -0.05, 0.02};
  m.knot.R_world_body = exp_so3({0.3, 0.2, -0.4});
  m.knot.v_world = {1.5, -1.0, 0.9};
  m.knot.omega_body = {6, -5, 6};
  m.a_world = {30, -30, 25};
  m.alpha_body = {300, 300, -260};
  return m;
}

// Every detector sees every marker every 2 ms.
std::vector<LineReading> read(const std::vector<LineDetector>& detectors, const WindowMotion& m, double sigma,
                              double end_s = 0.02) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<LineReading> readings;
  for (int n = 0; n * 1e-4 < end_s; ++n) {
    const LineDetector& d = detectors[static_cast<std::size_t>(n) % detectors.size()];
    const BodyMarker marker = body().markers[static_cast<std::size_t>(n / 3) % 4];
    const Eigen::Vector3d p = pose_after(m, n * 1e-4 - m.time_s) * marker.p_body;
    readings.push_back(
        {Timestamp(from_seconds(n * 1e-4)), d.id, marker.id, project(d, p)->value + sigma * normal(random), 0.0});
  }
  return readings;
}

WindowMotion nearby(const WindowMotion& m) {
  WindowMotion start;
  start.time_s = m.time_s;
  start.knot.p_world = m.knot.p_world + Eigen::Vector3d(0.01, 0.01, -0.01);
  start.knot.R_world_body = m.knot.R_world_body * exp_so3({0.03, -0.02, 0.02});
  return start;
}

TEST(WindowFit, FindsAnExactMotionFromItsReadings) {
  const auto detectors = two_blocks();
  const DetectorScene scene = scene_of(detectors, body());
  const auto placed = place_readings(detectors, body(), read(detectors, shaken(), 0.0));
  const auto fit = fit_window(scene, placed, nearby(shaken()), 18, 4.0);
  ASSERT_TRUE(fit);
  for (const double tau : {-0.01, 0.0, 0.01}) {
    const Vector6d off = difference(pose_after(shaken(), tau), pose_after(*fit, tau));
    EXPECT_LT(off.norm(), 1e-4) << tau;  // the priors of the rates pull a little
  }
  EXPECT_LT((fit->knot.v_world - shaken().knot.v_world).norm(), 0.01);
}

TEST(WindowFit, LeavesWhatItIsNotToFind) {
  const auto detectors = two_blocks();
  const auto placed = place_readings(detectors, body(), read(detectors, shaken(), 0.0));
  const auto fit = fit_window(scene_of(detectors, body()), placed, nearby(shaken()), 12, 4.0);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->a_world, Eigen::Vector3d::Zero());
  EXPECT_GT(fit->knot.v_world.norm(), 1.0);
  EXPECT_THROW(fit_window(scene_of(detectors, body()), placed, shaken(), 9, 4.0), std::invalid_argument);
}

TEST(WindowFits, ExplainWhatMovesRigidly) {
  const auto detectors = two_blocks();
  const auto windows = fit_windows(detectors, body(), read(detectors, shaken(), kSigma, 0.06), {});
  EXPECT_EQ(windows.windows, 3);
  EXPECT_EQ(windows.explained, 3);
  EXPECT_EQ(windows.largest_fit, 18);
  EXPECT_NEAR(windows.median_sigmas, 0.65, 0.12);  // 0.674 but for what 18 parameters of 200 readings take
  EXPECT_NEAR(*windows.median_rad, windows.median_sigmas * kSigma, 1e-12);
}

// What no rigid motion explains is not talked into one: each fifth reading is off by 3 mrad.
TEST(WindowFits, DoNotExplainWhatDoesNotMoveRigidly) {
  const auto detectors = two_blocks();
  auto readings = read(detectors, shaken(), kSigma);
  for (std::size_t i = 0; i < readings.size(); i += 5) readings[i].value += i % 2 == 0 ? 3e-3 : -3e-3;
  const auto windows = fit_windows(detectors, body(), readings, {});
  EXPECT_EQ(windows.windows, 1);
  EXPECT_EQ(windows.explained, 0);
}

TEST(WindowFits, PassOverWindowsOfFewReadings) {
  const auto detectors = two_blocks();
  auto readings = read(detectors, shaken(), kSigma);
  readings.resize(7);
  EXPECT_EQ(fit_windows(detectors, body(), readings, {}).windows, 0);
  WindowFitOptions options;
  options.window_s = 0;
  EXPECT_THROW(fit_windows(detectors, body(), readings, {}, options), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
