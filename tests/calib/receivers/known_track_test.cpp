// SPDX-License-Identifier: Apache-2.0
#include "calib/receivers/known_track.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::vector<TimedPosition> circle(double step_s, int count) {
  std::vector<TimedPosition> positions;
  for (int i = 0; i < count; ++i) {
    const double t = i * step_s;
    positions.push_back({Timestamp(from_seconds(t)), {10.0 * std::cos(0.7 * t), 10.0 * std::sin(0.7 * t), t}});
  }
  return positions;
}

TEST(KnownTrack, FollowsACurveBetweenItsPositions) {
  const KnownTrack track(circle(0.2, 50));
  // 7 m/s at 4.9 m/s²: a straight line would be off by a h² / 8 = 25 mm.
  const double t = 3.1;
  const auto point = track.at(t);
  ASSERT_TRUE(point);
  EXPECT_LT((point->p_world - Eigen::Vector3d(10.0 * std::cos(0.7 * t), 10.0 * std::sin(0.7 * t), t)).norm(), 1e-3);
  EXPECT_LT((point->v_world - Eigen::Vector3d(-7.0 * std::sin(0.7 * t), 7.0 * std::cos(0.7 * t), 1.0)).norm(), 0.05);
}

TEST(KnownTrack, HasTheSlopeOfItsPath) {
  const KnownTrack track(circle(0.2, 50));
  for (const double t : {0.25, 2.0001, 5.55, 9.5}) {
    const Eigen::Vector3d slope = (track.at(t + 1e-5)->p_world - track.at(t - 1e-5)->p_world) / 2e-5;
    EXPECT_LT((slope - track.at(t)->v_world).norm(), 1e-5) << t;
  }
}

TEST(KnownTrack, EndsAtItsLastPositionButOne) {
  const KnownTrack track(circle(0.2, 10));
  EXPECT_FALSE(track.at(0.19));
  EXPECT_TRUE(track.at(0.2));
  EXPECT_TRUE(track.at(1.6));
  EXPECT_FALSE(track.at(1.61));
  EXPECT_FALSE(track.at(std::nan("")));
}

TEST(KnownTrack, IsEmptyInAGap) {
  auto positions = circle(0.2, 20);
  positions.erase(positions.begin() + 8, positions.begin() + 12);
  const KnownTrack track(positions);
  EXPECT_FALSE(track.at(1.9, 0.3));
  EXPECT_TRUE(track.at(0.5, 0.3));
  EXPECT_THROW(KnownTrack(circle(0.2, 3)), std::invalid_argument);
  EXPECT_THROW(KnownTrack(circle(0.0, 5)), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
