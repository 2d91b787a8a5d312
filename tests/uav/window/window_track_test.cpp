// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_track.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/uav/seen_window.h"

namespace alidade {
namespace {

TEST(WindowTrack, GrowsFromFourBearingsToAllOfItsTarget) {
  const SeenWindow seen = see(3, 2);
  const auto all = seen.of_target(1);
  ASSERT_EQ(all.size(), 15u);
  const std::vector<std::size_t> few{all[0], all[4], all[8], all[14]};
  const auto track = grow_track(seen.window, few, seen.is_free);
  ASSERT_TRUE(track);
  for (const std::size_t i : all) EXPECT_EQ(track->bearing_of_scan[seen.window.scan_of[i]], i);
  EXPECT_GT(track->log_ratio, 50.0);
}

TEST(WindowTrack, LeavesTakenBearingsAlone) {
  SeenWindow seen = see(1, 2);
  const auto all = seen.of_target(0);
  seen.is_free[all[7]] = 0;
  const std::vector<std::size_t> few{all[0], all[4], all[8], all[14]};
  const auto track = grow_track(seen.window, few, seen.is_free);
  ASSERT_TRUE(track);
  EXPECT_EQ(track->bearing_of_scan[seen.window.scan_of[all[7]]], kNoBearing);
}

TEST(WindowTrack, LosesByAMissAndByAWrongBearing) {
  const SeenWindow seen = see(2, 3);
  const auto own = seen.of_target(0), other = seen.of_target(1);
  const std::vector<std::size_t> few{own[0], own[4], own[8], own[14]};
  WindowTrack track = *grow_track(seen.window, few, seen.is_free);
  const double whole = track.log_ratio;
  track.bearing_of_scan[seen.window.scan_of[own[7]]] = kNoBearing;
  ASSERT_TRUE(refit(seen.window, track));
  EXPECT_LT(track.log_ratio, whole);
  track.bearing_of_scan[seen.window.scan_of[other[7]]] = other[7];
  ASSERT_TRUE(refit(seen.window, track));
  EXPECT_LT(track.log_ratio, whole);
}

// A target that is there for a part of the window only: scans before and after it count as much as its coming and
// going, however many they are.
TEST(WindowTrack, PaysOnceForComingLate) {
  const SeenWindow seen = see(1, 4);
  const auto all = seen.of_target(0);
  const auto without_first = [&](std::size_t count) {
    WindowTrack track;
    track.bearing_of_scan.assign(seen.window.scans.size(), kNoBearing);
    for (std::size_t k = count; k < all.size(); ++k) track.bearing_of_scan[seen.window.scan_of[all[k]]] = all[k];
    track.motion = grow_track(seen.window, all, seen.is_free)->motion;
    EXPECT_TRUE(refit(seen.window, track));
    double gains = 0.0;
    for (std::size_t k = count; k < all.size(); ++k) gains += seen.window.log_gain[all[k]];
    return track.log_ratio - gains + 0.5 * track.motion.chi2 -
           track.motion.covariance.ldlt().vectorD().array().log().sum() / 2;
  };
  const double whole = without_first(0);
  EXPECT_NEAR(without_first(1) - whole, std::log(0.1), 1e-6);
  EXPECT_NEAR(without_first(3) - whole, std::log(0.01), 1e-6);
  EXPECT_NEAR(without_first(6) - whole, std::log(0.01), 1e-6);
}

TEST(WindowTrack, IsNoneOfBearingsByOneReceiver) {
  const SeenWindow seen = see(1, 5);
  std::vector<std::size_t> alone;
  for (const std::size_t i : seen.of_target(0)) {
    if (seen.bearings[i].receiver == 0) alone.push_back(i);
  }
  EXPECT_FALSE(grow_track(seen.window, alone, seen.is_free));
}

TEST(WindowTrack, IsFarFromWhatLiesBehind) {
  SeenWindow seen = see(1, 6);
  const auto all = seen.of_target(0);
  const WindowTrack track = *grow_track(seen.window, all, seen.is_free);
  EXPECT_LT(innovation_chi2(seen.window, all[3], track.motion), seen.window.options.gate_chi2);
  seen.window.rows[all[3]].direction *= -1.0;
  EXPECT_GT(innovation_chi2(seen.window, all[3], track.motion), 1e12);
}

}  // namespace
}  // namespace alidade
