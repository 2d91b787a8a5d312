// SPDX-License-Identifier: Apache-2.0
#include "evaluation/track_jumps.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

// 7 m/s in a circle of 10 m: 4.9 m/s².
std::vector<TimedPosition> circle() {
  std::vector<TimedPosition> track;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.2 * i;
    track.push_back({Timestamp(from_seconds(t)), {10.0 * std::cos(0.7 * t), 10.0 * std::sin(0.7 * t), 5.0}});
  }
  return track;
}

TEST(TrackJumps, AreNoneOfABriskFlight) {
  EXPECT_TRUE(track_jumps(circle()).empty());
}

TEST(TrackJumps, AreFoundAlsoWhenEverySecondPositionIsOne) {
  auto track = circle();
  for (const std::size_t i : {20u, 60u, 62u, 64u}) track[i].p += Eigen::Vector3d(1.2, 0.2, -0.9);
  EXPECT_EQ(track_jumps(track), (std::vector<std::size_t>{20, 60, 62, 64}));
}

TEST(TrackJumps, LeaveTheEndsAlone) {
  auto track = circle();
  track[1].p.z() += 2.0;
  EXPECT_TRUE(track_jumps(track).empty());
  EXPECT_TRUE(track_jumps({}).empty());
  EXPECT_THROW(track_jumps(track, {.least_jump_m = 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
