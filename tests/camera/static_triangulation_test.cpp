// SPDX-License-Identifier: Apache-2.0
#include "camera/static_triangulation.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

Timestamp at(double s) {
  return Timestamp(from_seconds(s));
}

Bearing bearing(int receiver, double t_s, const Eigen::Vector3d& origin, const Eigen::Vector3d& p) {
  Bearing b;
  b.time = at(t_s);
  b.receiver = receiver;
  b.origin_world = origin;
  b.direction_world = (p - origin).normalized();
  return b;
}

const Eigen::Vector3d kWest(-10, 0, 0), kSouth(0, -10, 0);

TEST(NearestBearings, AreOnePerReceiverAndWithinTheTime) {
  const Eigen::Vector3d p(0, 0, 5);
  const std::vector<Bearing> bearings{bearing(0, 0.80, kWest, p), bearing(0, 0.98, kWest, p),
                                      bearing(1, 1.01, kSouth, p), bearing(0, 1.03, kWest, p),
                                      bearing(2, 1.30, kSouth, p)};
  const auto nearest = nearest_bearings(bearings, at(1.0), std::chrono::milliseconds(100));
  ASSERT_EQ(nearest.size(), 2u);
  EXPECT_EQ(nearest[0].time, at(0.98));
  EXPECT_EQ(nearest[1].receiver, 1);
}

TEST(StaticTriangulation, IsExactForWhatStandsStill) {
  const Eigen::Vector3d p(1, 2, 5);
  const std::vector<Bearing> bearings{bearing(0, 0.95, kWest, p), bearing(1, 1.05, kSouth, p)};
  const auto met = triangulate_static(bearings, at(1.0));
  ASSERT_TRUE(met);
  EXPECT_TRUE(met->p_world.isApprox(p, 1e-12));
}

TEST(StaticTriangulation, LeavesOutWhenEachReceiverLooked) {
  // 10 m/s along x, seen 0.05 s before and after: each sees it half a metre from where it is.
  const std::vector<Bearing> bearings{bearing(0, 0.95, kWest, {-0.5, 0, 5}), bearing(1, 1.05, kSouth, {0.5, 0, 5})};
  const auto met = triangulate_static(bearings, at(1.0));
  ASSERT_TRUE(met);
  EXPECT_GT((met->p_world - Eigen::Vector3d(0, 0, 5)).norm(), 0.2);
}

TEST(StaticTriangulation, IsEmptyWithTooFewReceivers) {
  const std::vector<Bearing> bearings{bearing(0, 0.95, kWest, {0, 0, 5}), bearing(1, 1.05, kSouth, {0, 0, 5})};
  EXPECT_FALSE(triangulate_static(bearings, at(1.0), {.least_receivers = 3}));
  EXPECT_FALSE(triangulate_static(bearings, at(1.12)));
  EXPECT_THROW(triangulate_static(bearings, at(1.0), {.least_receivers = 1}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
