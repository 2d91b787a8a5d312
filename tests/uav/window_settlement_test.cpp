// SPDX-License-Identifier: Apache-2.0
#include "uav/window_settlement.h"

#include <gtest/gtest.h>

#include "tests/uav/seen_window.h"
#include "uav/window_seeds.h"

namespace alidade {
namespace {

TEST(WindowSettlement, KeepsOneOfTwins) {
  SeenWindow seen = see(2, 4, 0.9);
  auto tracks = find_tracks(seen.window, Crowd::Whole, seen.is_free);
  ASSERT_EQ(tracks.size(), 2u);
  tracks.push_back(tracks[0]);
  EXPECT_EQ(settle_tracks(seen.window, tracks).size(), 2u);
}

TEST(WindowSettlement, GivesEachBearingToWhomItFitsBest) {
  SeenWindow seen = see(6, 5, 0.9);
  const auto tracks = settle_tracks(seen.window, find_tracks(seen.window, Crowd::Whole, seen.is_free));
  ASSERT_EQ(tracks.size(), 6u);
  auto swapped = tracks;
  std::swap(swapped[0].bearing_of_scan[7], swapped[1].bearing_of_scan[7]);
  const auto again = settle_tracks(seen.window, swapped);
  ASSERT_EQ(again.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(again[i].bearing_of_scan, tracks[i].bearing_of_scan);
}

TEST(WindowSettlement, OfNothingIsNothing) {
  const SeenWindow seen = see(1, 6, 0.9);
  EXPECT_TRUE(settle_tracks(seen.window, {}).empty());
}

}  // namespace
}  // namespace alidade
