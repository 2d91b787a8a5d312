// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_residuals.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

const RigidBody kBody{"probe", {{7, {0.1, 0.0, 0.0}}, {8, {0.0, 0.2, -0.1}}}};

std::vector<LineDetector> some_detectors() {
  LineDetector upright{1, "a", FocalLine{}};
  LineDetector moved{2, "b", FocalLine{}};
  moved.T_world_station.translation() = Eigen::Vector3d(1, 0.5, 0.2);
  moved.T_station_detector.linear() = exp_so3({0.0, 0.3, 1.2});
  moved.sigma = 2e-4;
  return {upright, moved};
}

MotionState some_motion() {
  MotionState state;
  state.time = Timestamp(10s);
  state.T_world_body.translation() = Eigen::Vector3d(0.2, 0.1, 3.0);
  state.T_world_body.linear() = exp_so3({0.3, -0.2, 0.9});
  state.v_world = {1.0, -2.0, 0.5};
  state.omega_body = {0.4, 3.0, -1.0};
  state.a_world = {4.0, 0.0, -9.0};
  state.alpha_body = {10.0, 20.0, 5.0};
  return state;
}

TEST(BodyResiduals, AreWhatWasAddedToTheReadingsOfAMovingBody) {
  const auto detectors = some_detectors();
  const MotionState state = some_motion();
  std::vector<LineReading> readings;
  std::vector<double> added;
  for (const auto offset : {0ms, 2ms}) {
    const MotionState then = predict_without_noise(state, state.time + offset);
    for (const LineDetector& d : detectors) {
      for (const BodyMarker& m : kBody.markers) {
        added.push_back(1e-5 * static_cast<double>(added.size() + 1));
        const double value = project(d, then.T_world_body * m.p_body)->value + added.back();
        readings.push_back({state.time + offset, d.id, m.id, value, m.id == 7 ? 5e-4 : 0.0});
      }
    }
  }
  const auto residuals = residuals_of(DetectorArray(detectors), kBody, readings, state);
  ASSERT_EQ(residuals.size(), 8u);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    ASSERT_TRUE(residuals[i]);
    EXPECT_NEAR(residuals[i]->value, added[i], 1e-9);
    const double own = readings[i].detector == 1 ? 1e-4 : 2e-4;
    EXPECT_EQ(residuals[i]->sigma, readings[i].marker == 7 ? 5e-4 : own);
  }
}

TEST(BodyResiduals, AgreeWithTheChiSquareOfTheUpdate) {
  const auto detectors = some_detectors();
  const DetectorArray array(detectors);
  const MotionState state = some_motion();
  std::vector<LineReading> readings;
  for (int i = 0; i < 12; ++i) readings.push_back({state.time + (i - 6) * 1ms, 1 + i % 2, 7 + i % 2, 0.01 * i, 0.0});
  BodyReadings update(array, kBody, readings, 1.0);
  update.linearise(state);
  const auto residuals = residuals_of(array, kBody, readings, state);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double whitened = residuals[i]->value / residuals[i]->sigma;
    EXPECT_NEAR(whitened * whitened / update.chi2()(static_cast<Eigen::Index>(i)), 1.0, 1e-9);
  }
}

TEST(BodyResiduals, AreEmptyForAMarkerBehindTheDetector) {
  MotionState state = some_motion();
  state.T_world_body.translation().z() = -3.0;
  const std::vector<LineReading> readings{{state.time, 1, 7, 0.0, 0.0}};
  EXPECT_FALSE(residuals_of(DetectorArray(some_detectors()), kBody, readings, state)[0]);
}

TEST(BodyResiduals, RefuseWhatIsNotThere) {
  const DetectorArray detectors(some_detectors());
  const std::vector<LineReading> no_detector{{Timestamp(10s), 9, 7, 0.0, 0.0}}, no_marker{{Timestamp(10s), 1, 9, 0, 0}};
  EXPECT_THROW(residuals_of(detectors, kBody, no_detector, some_motion()), std::invalid_argument);
  EXPECT_THROW(residuals_of(detectors, kBody, no_marker, some_motion()), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
