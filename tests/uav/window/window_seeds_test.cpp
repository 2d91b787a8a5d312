// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_seeds.h"

#include <gtest/gtest.h>

#include "tests/uav/seen_window.h"

namespace alidade {
namespace {

TEST(WindowSeeds, TakeWhatTheyExplain) {
  SeenWindow seen = see(4, 2, 0.9);
  const auto tracks = find_tracks(seen.window, {Crowd::Whole, 0.4}, seen.is_free);
  EXPECT_EQ(tracks.size(), 4u);
  for (const WindowTrack& track : tracks) {
    for (const std::size_t bearing : track.bearing_of_scan) {
      EXPECT_TRUE(bearing == kNoBearing || !seen.is_free[bearing]);
    }
  }
  EXPECT_TRUE(find_tracks(seen.window, {Crowd::Rest, 0.0}, seen.is_free).empty());
}

TEST(WindowSeeds, FindARareTargetAmongTheRestOnly) {
  SeenWindow seen = see(1, 3, 0.9);
  int kept = 0;
  for (std::size_t i = 0; i < seen.bearings.size(); ++i) seen.is_free[i] = i % 3 != 1 && ++kept <= 8;
  ASSERT_GE(kept, 8);
  auto is_free = seen.is_free;
  EXPECT_TRUE(find_tracks(seen.window, {Crowd::Whole, 0.4}, is_free).empty());
  EXPECT_EQ(find_tracks(seen.window, {Crowd::Rest, 0.0}, seen.is_free).size(), 1u);
}

}  // namespace
}  // namespace alidade
