// SPDX-License-Identifier: Apache-2.0
#include "geometry/positions.h"

#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using namespace std::chrono_literals;

std::vector<TimedPosition> three() {
  return {{Timestamp(0s), {0, 0, 0}}, {Timestamp(1s), {1, 2, -4}}, {Timestamp(5s), {2, 2, 2}}};
}

TEST(PositionAt, LiesOnTheLineBetweenNeighbours) {
  const auto p = position_at(three(), Timestamp(250ms), 2s);
  ASSERT_TRUE(p);
  EXPECT_NEAR((*p - Eigen::Vector3d(0.25, 0.5, -1)).norm(), 0, 1e-12);
}

TEST(PositionAt, IsExactAtAPositionEvenBesideAGap) {
  EXPECT_EQ(*position_at(three(), Timestamp(5s), 2s), Eigen::Vector3d(2, 2, 2));
  EXPECT_EQ(*position_at(three(), Timestamp(0s), 2s), Eigen::Vector3d(0, 0, 0));
}

TEST(PositionAt, IsEmptyOutsideAndInAGap) {
  EXPECT_FALSE(position_at(three(), Timestamp(-1ns), 2s));
  EXPECT_FALSE(position_at(three(), Timestamp(5s + 1ns), 2s));
  EXPECT_FALSE(position_at(three(), Timestamp(3s), 2s));
  EXPECT_TRUE(position_at(three(), Timestamp(3s), 4s));
  EXPECT_FALSE(position_at({}, Timestamp(0s), 2s));
}

}  // namespace
}  // namespace alidade
