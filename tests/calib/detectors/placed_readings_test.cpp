// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/placed_readings.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(PlacedReadings, GoByPlaceAndLeaveOutStrangers) {
  const std::vector<LineDetector> detectors{{7, "a", FocalLine{}}, {3, "b", FocalLine{}}};
  const RigidBody body{"body", {{9, {1, 2, 3}}, {4, {0, 0, 0}}}};
  EXPECT_EQ(scene_of(detectors, body).markers.front(), Eigen::Vector3d(1, 2, 3));
  const std::vector<LineReading> readings{{Timestamp(from_seconds(0.5)), 3, 9, 0.25, 0.0},
                                          {Timestamp(from_seconds(0.5)), 8, 9, 0.25, 0.0},
                                          {Timestamp(from_seconds(0.5)), 7, 5, 0.25, 0.0},
                                          {Timestamp(from_seconds(0.6)), 7, 4, 0.75, 2e-3}};
  const auto placed = place_readings(detectors, body, readings);
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_EQ(placed[0].detector, 1u);
  EXPECT_EQ(placed[0].marker, 0u);
  EXPECT_EQ(placed[0].sigma, detectors[1].sigma);
  EXPECT_EQ(placed[1].detector, 0u);
  EXPECT_EQ(placed[1].time_s, 0.6);
  EXPECT_EQ(placed[1].sigma, 2e-3);
}

}  // namespace
}  // namespace alidade
