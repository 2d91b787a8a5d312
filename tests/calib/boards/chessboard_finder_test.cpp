// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/chessboard_finder.h"

#include <utility>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/support/rendered_chessboard.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

constexpr double kQuarter = 1.5707963267948966;

double largest_error(const std::vector<Vector2d>& truth, const std::vector<Vector2d>& found) {
  double largest = truth.size() == found.size() ? 0 : 1e9;
  for (size_t i = 0; i < std::min(truth.size(), found.size()); ++i) {
    largest = std::max(largest, (truth[i] - found[i]).norm());
  }
  return largest;
}

TEST(ChessboardFinder, NumbersCornersFromTheDarkSquareHoweverTheBoardIsTurned) {
  for (const double turn_rad : {0.1, 0.1 + kQuarter, 0.1 + 2 * kQuarter, 0.1 + 3 * kQuarter}) {
    const auto board = test::placed_chessboard(6, 5, {.square_px = 24, .turn_rad = turn_rad, .tilt = {0.02, 0.01}});
    const auto found = find_chessboard(test::render(board), 6, 5);
    ASSERT_TRUE(found) << turn_rad;
    EXPECT_LT(largest_error(test::true_corners(board), found->corners), 1.0) << turn_rad;
  }
}

TEST(ChessboardFinder, StartsAtTheTopLeftWhereThePatternHasNoTop) {
  const auto board = test::placed_chessboard(6, 4, {.square_px = 24, .turn_rad = 0.1});
  const auto turned = test::placed_chessboard(6, 4, {.square_px = 24, .turn_rad = 0.1 + 2 * kQuarter});
  for (const auto& image : {test::render(board), test::render(turned)}) {
    const auto found = find_chessboard(image, 6, 4);
    ASSERT_TRUE(found);
    EXPECT_LT(largest_error(test::true_corners(board), found->corners), 1.0);
  }
}

TEST(ChessboardFinder, NumbersSquareBoardsClockwiseToo) {
  const auto board = test::placed_chessboard(5, 5, {.square_px = 24, .turn_rad = 0.1});
  const auto turned = test::placed_chessboard(5, 5, {.square_px = 24, .turn_rad = 0.1 + 2 * kQuarter});
  const auto found = find_chessboard(test::render(turned), 5, 5);
  ASSERT_TRUE(found);
  EXPECT_LT(largest_error(test::true_corners(board), found->corners), 1.0);
}

TEST(ChessboardFinder, TakesAMirroredBoardForABoard) {
  const auto board = test::placed_chessboard(6, 5, {.square_px = 24});
  cv::Mat mirrored;
  cv::flip(test::render(board), mirrored, 1);
  const auto found = find_chessboard(mirrored, 6, 5);
  ASSERT_TRUE(found);
  const Vector2d x = found->corners[1] - found->corners[0], y = found->corners[6] - found->corners[0];
  EXPECT_GT(x.x() * y.y() - x.y() * y.x(), 0);
}

TEST(ChessboardFinder, SearchesLargeImagesReduced) {
  auto board = test::placed_chessboard(4, 3, {.pixel = {600, 160}, .square_px = 40, .turn_rad = 0.1});
  board.width = 1200;
  board.height = 320;
  const auto found = find_chessboard(test::render(board), 4, 3);
  ASSERT_TRUE(found);
  EXPECT_LT(largest_error(test::true_corners(board), found->corners), 1.5);
}

TEST(ChessboardFinder, IsEmptyWithoutTheWholeBoard) {
  const cv::Mat blank(240, 320, CV_8UC1, cv::Scalar(128));
  EXPECT_FALSE(find_chessboard(blank, 6, 5));
  EXPECT_FALSE(guess_chessboard(blank));
  const auto half = test::placed_chessboard(6, 5, {.pixel = {290, 120}, .square_px = 24});
  EXPECT_FALSE(find_chessboard(test::render(half), 6, 5));
  const auto larger = test::placed_chessboard(7, 6, {.square_px = 24});
  EXPECT_FALSE(find_chessboard(test::render(larger), 6, 5));
}

TEST(ChessboardFinder, FindsBoardsThatAreSmallSteepOrBlurred) {
  const std::vector<test::BoardPlacement> placements{{.square_px = 6, .turn_rad = 0.3},
                                                     {.square_px = 14, .turn_rad = 0.5, .tilt = {0.1, 0}}};
  for (const auto& placement : placements) {
    const auto board = test::placed_chessboard(9, 6, placement);
    EXPECT_TRUE(find_chessboard(test::with_noise(test::render(board), 3, 1), 9, 6)) << placement.square_px;
  }
  const auto board = test::placed_chessboard(9, 6, {.square_px = 20, .turn_rad = 0.2});
  EXPECT_TRUE(find_chessboard(test::with_noise(test::render(board, {4, 4}), 3, 1), 9, 6));
}

TEST(ChessboardFinder, TakesNeitherLargerNorSmallerBoardsForTheOneAsked) {
  for (const auto& [columns, rows] :
       {std::pair(7, 6), std::pair(7, 5), std::pair(6, 6), std::pair(5, 5), std::pair(6, 4)}) {
    const auto image = test::render(test::placed_chessboard(columns, rows, {.square_px = 22, .turn_rad = 0.1}));
    EXPECT_FALSE(find_chessboard(image, 6, 5)) << columns << "x" << rows;
  }
}

TEST(ChessboardFinder, SeesNoBoardInNoise) {
  for (int seed = 1; seed <= 3; ++seed) {
    const auto image = test::with_noise(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), 40, seed);
    EXPECT_FALSE(find_chessboard(image, 4, 3)) << seed;
    EXPECT_FALSE(guess_chessboard(image)) << seed;
  }
}

TEST(ChessboardFinder, GuessesTheSize) {
  for (const double turn_rad : {0.1, 0.1 + kQuarter}) {
    const auto board = test::placed_chessboard(6, 5, {.square_px = 24, .turn_rad = turn_rad});
    const auto guess = guess_chessboard(test::render(board));
    ASSERT_TRUE(guess);
    EXPECT_EQ(guess->columns, 6);
    EXPECT_EQ(guess->rows, 5);
    EXPECT_LT(largest_error(test::true_corners(board), guess->corners), 1.0);
  }
}

TEST(ChessboardFinder, LetsImagesVoteOnTheSize) {
  EXPECT_FALSE(most_common_size({}));
  const std::vector<ChessboardGrid> grids{{6, 4, {}}, {9, 6, {}}, {7, 4, {}}, {9, 6, {}}, {6, 4, {}}};
  EXPECT_EQ(most_common_size(grids), (GridSize{9, 6}));
}

TEST(ChessboardFinder, RefusesImpossibleInput) {
  EXPECT_THROW(find_chessboard(cv::Mat(80, 80, CV_8UC3), 6, 5), std::invalid_argument);
  EXPECT_THROW(guess_chessboard(cv::Mat(80, 80, CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(find_chessboard(cv::Mat(80, 80, CV_8UC1), 2, 5), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
