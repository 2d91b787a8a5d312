// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/placed_markers.h"

#include <gtest/gtest.h>

#include "calib/boards/board_text.h"

namespace alidade {
namespace {

// All markers as a camera with a projective map sees them.
std::vector<FoundMarker> seen_markers(const Board& board) {
  Eigen::Matrix3d H;
  H << 1500, 200, 320, -100, 1400, 240, 0.4, -0.3, 1;
  std::vector<FoundMarker> found;
  for (const BoardMarker& marker : markers(board)) {
    FoundMarker seen{marker.id, {}};
    for (std::size_t c = 0; c < 4; ++c) seen.corners[c] = map_by(H, marker.corners[c]);
    found.push_back(seen);
  }
  return found;
}

const Board kBoard = parse_board("charuco:8x6:30mm:18mm:4X4_50");

TEST(PlacedMarkers, AllAgreeOnTheirBoard) {
  const auto placed = place_consistently(seen_markers(kBoard), markers(kBoard));
  ASSERT_EQ(placed.size(), 24u);
  const auto H = homography_of(placed);
  ASSERT_TRUE(H);
  for (const PlacedMarker& marker : placed) {
    EXPECT_LT((map_by(*H, marker.on_board.corners[2]) - marker.pixels[2]).norm(), 1e-3);
  }
}

TEST(PlacedMarkers, AWrongIdEndsThere) {
  auto found = seen_markers(kBoard);
  found[5].id = 18;
  found[18].id = 40;  // the board has no such marker
  const auto placed = place_consistently(found, markers(kBoard));
  EXPECT_GE(placed.size(), 20u);  // neighbours on the rim may be outvoted
  for (const PlacedMarker& marker : placed) EXPECT_NE(marker.on_board.id, 18);
}

TEST(PlacedMarkers, NoneAgreeOnTheOtherLayout) {
  Board other = kBoard;
  other.layout = CharucoLayout::MarkerFirst;
  EXPECT_TRUE(place_consistently(seen_markers(kBoard), markers(other)).empty());
}

TEST(PlacedMarkers, GiveNoMapInOneLine) {
  const std::vector<Eigen::Vector2d> line{{0, 0}, {1, 1}, {2, 2}};
  EXPECT_FALSE(homography_between(line, line, Outliers::None));
}

}  // namespace
}  // namespace alidade
