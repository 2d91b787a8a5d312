// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_settlement.h"

#include <gtest/gtest.h>

#include "tests/uav/seen_window.h"
#include "uav/window/window_seeds.h"

namespace alidade {
namespace {

TEST(WindowSettlement, KeepsOneOfTwins) {
  SeenWindow seen = see(2, 4, 0.9);
  auto tracks = find_tracks(seen.window, {Crowd::Whole, 0.4}, seen.is_free);
  ASSERT_EQ(tracks.size(), 2u);
  tracks.push_back(tracks[0]);
  EXPECT_EQ(settle_tracks(seen.window, tracks).size(), 2u);
}

TEST(WindowSettlement, GivesEachBearingToWhomItFitsBest) {
  SeenWindow seen = see(6, 5, 0.9);
  const auto tracks = settle_tracks(seen.window, find_tracks(seen.window, {Crowd::Whole, 0.4}, seen.is_free));
  ASSERT_EQ(tracks.size(), 6u);
  auto swapped = tracks;
  std::swap(swapped[0].bearing_of_scan[7], swapped[1].bearing_of_scan[7]);
  const auto again = settle_tracks(seen.window, swapped);
  ASSERT_EQ(again.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(again[i].bearing_of_scan, tracks[i].bearing_of_scan);
}

// Two fly side by side, four to six sigma apart: each gate holds both.
TEST(WindowSettlement, TellsCloseNeighboursApart) {
  TargetSceneOptions options;
  options.spread_m = 0.6;
  options.least_distance_m = 0.4;
  options.scatter_m_s = 0.02;
  int right = 0, all = 0;
  for (options.seed = 1; options.seed <= 20; ++options.seed) {
    const SeenWindow seen = see(options);
    std::vector<WindowTrack> tracks;
    for (int target : {0, 1}) {
      WindowTrack track;
      track.bearing_of_scan.assign(seen.window.scans.size(), kNoBearing);
      for (const std::size_t i : seen.of_target(target)) track.bearing_of_scan[seen.window.scan_of[i]] = i;
      ASSERT_TRUE(refit(seen.window, track));
      tracks.push_back(track);
    }
    const auto settled = settle_tracks(seen.window, tracks);
    ASSERT_EQ(settled.size(), 2u);
    for (std::size_t s = 0; s < seen.window.scans.size(); ++s) {
      right += settled[0].bearing_of_scan[s] == tracks[0].bearing_of_scan[s];
      ++all;
    }
  }
  EXPECT_GT(right, 0.9 * all);
}

TEST(WindowSettlement, OfNothingIsNothing) {
  const SeenWindow seen = see(1, 6, 0.9);
  EXPECT_TRUE(settle_tracks(seen.window, {}).empty());
}

}  // namespace
}  // namespace alidade
