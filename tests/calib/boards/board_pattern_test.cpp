// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_pattern.h"

#include <gtest/gtest.h>

#include "calib/boards/board_text.h"

namespace alidade {
namespace {

double black_area(const BoardPattern& pattern) {
  double area = 0;
  for (const auto& box : pattern.black) area += box.volume();
  return area;
}

TEST(BoardPattern, OfAChessboardIsHalfBlackAndStartsBlack) {
  const BoardPattern pattern = pattern_of(parse_board("chessboard:9x6:10mm"));
  EXPECT_EQ(pattern.black.size(), 35u);
  EXPECT_NEAR(black_area(pattern), 0.5 * pattern.extent.volume(), 1e-12);
  EXPECT_TRUE(pattern.black.front().min().isApprox(Eigen::Vector2d(-0.01, -0.01)));
}

TEST(BoardPattern, PutsMarkersWhereTheLayoutSays) {
  Board board = parse_board("charuco:8x6:30mm:20mm:5X5_100");
  auto placed = markers(board);
  ASSERT_EQ(placed.size(), 24u);
  EXPECT_EQ(marker_count(board), 24);
  EXPECT_EQ(placed[0].column, 1);
  EXPECT_EQ(placed[4].column, 0);
  EXPECT_EQ(placed[4].row, 1);
  EXPECT_TRUE(placed[0].corners[0].isApprox(Eigen::Vector2d(0.005, -0.025)));
  EXPECT_TRUE(placed[0].corners[2].isApprox(Eigen::Vector2d(0.025, -0.005)));
  board.layout = CharucoLayout::MarkerFirst;
  placed = markers(board);
  EXPECT_EQ(placed[0].column, 0);
  EXPECT_EQ(placed[4].column, 1);
}

TEST(BoardPattern, OfAnOddBoardHasOneMarkerMoreWhereItStartsWithOne) {
  Board board = parse_board("charuco:5x5:30mm:20mm:4X4_50");
  EXPECT_EQ(marker_count(board), 12);
  EXPECT_EQ(markers(board).size(), 12u);
  board.layout = CharucoLayout::MarkerFirst;
  EXPECT_EQ(marker_count(board), 13);
  EXPECT_EQ(markers(board).size(), 13u);
}

TEST(BoardPattern, OfAnAprilGridHasItsTagsAtTheCornersOfTheBoard) {
  const Board board = parse_board("aprilgrid:3x2:80mm:20mm");
  const auto corners = corners_m(board);
  for (const BoardMarker& tag : markers(board)) {
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_TRUE(tag.corners[c].isApprox(corners[4 * static_cast<std::size_t>(tag.id) + c].head<2>()));
    }
  }
  EXPECT_TRUE(pattern_of(board).extent.sizes().isApprox(Eigen::Vector2d(0.32, 0.22)));
}

TEST(BoardPattern, WantsEnoughMarkersInTheDictionary) {
  Board board = parse_board("charuco:8x6:30mm:20mm:5X5_100");
  board.columns = 20;
  board.rows = 20;
  EXPECT_THROW(pattern_of(board), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
