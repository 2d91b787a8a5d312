// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/bearing_scans.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace alidade {
namespace {

Bearing seen(int receiver, int time_ms) {
  Bearing bearing;
  bearing.receiver = receiver;
  bearing.time = Timestamp(std::chrono::milliseconds(time_ms));
  return bearing;
}

TEST(BearingScans, AreOfOneReceiverAndOneLook) {
  const std::vector<Bearing> bearings{seen(0, 0), seen(1, 1), seen(0, 10), seen(0, 30), seen(1, 40), seen(0, 31)};
  std::vector<Bearing> in_order = bearings;
  std::sort(in_order.begin(), in_order.end(), comes_before);
  const auto scans = scans_of(in_order, 0.03);
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_EQ(scans[0].receiver, 0);
  EXPECT_EQ(scans[0].bearings.size(), 3U);
  EXPECT_EQ(scans[1].receiver, 1);
  EXPECT_EQ(scans[1].bearings.size(), 1U);
  EXPECT_EQ(scans[2].begin(), seen(0, 31).time);
  EXPECT_EQ(scans[3].end(), seen(1, 40).time);
}

TEST(BearingScans, OfNoLengthAreOfOneMoment) {
  const std::vector<Bearing> bearings{seen(0, 0), seen(0, 0), seen(0, 1)};
  EXPECT_EQ(scans_of(bearings, 0.0).size(), 2U);
}

// The target is what no estimator may look at.
TEST(BearingOrder, DependsOnWhatBearingsSayAlone) {
  Bearing a = seen(0, 5), b = seen(0, 5);
  b.target = 3;
  EXPECT_FALSE(comes_before(a, b));
  EXPECT_FALSE(comes_before(b, a));
  b.direction_world = Eigen::Vector3d::UnitX();
  EXPECT_NE(comes_before(a, b), comes_before(b, a));
  EXPECT_TRUE(comes_before(seen(7, 4), a));
}

}  // namespace
}  // namespace alidade
