// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/corner_refinement.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/rendered_chessboard.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

// The true corners, each moved another way by up to `off_px` a coordinate.
std::vector<BoardCorner> started_beside(const test::RenderedChessboard& board, double off_px) {
  std::vector<BoardCorner> corners;
  for (const Vector2d& pixel : test::true_corners(board)) {
    const int id = static_cast<int>(corners.size());
    corners.push_back({id, pixel + off_px * Vector2d(id % 3 - 1, (id + 1) % 3 - 1)});
  }
  return corners;
}

double largest_error(const test::RenderedChessboard& board, std::span<const BoardCorner> corners) {
  const auto truth = test::true_corners(board);
  double largest = 0;
  for (const BoardCorner& corner : corners) largest = std::max(largest, (corner.pixel - truth[corner.id]).norm());
  return largest;
}

TEST(CornerRefinement, FindsCornersOfSquaresOfAnySize) {
  // Noise of 2 in a contrast of 85 allows 0.013 px a coordinate on the smallest squares, 0.003 px on the largest.
  for (const double square_px : {10.0, 16.0, 30.0, 55.0}) {
    const auto board = test::placed_chessboard(4, 3, {.square_px = square_px, .turn_rad = 0.2, .tilt = {0.04, 0.02}});
    const auto refined =
        refine_corners(test::with_noise(test::render(board), 2, 1), started_beside(board, 0.06 * square_px), 4);
    ASSERT_EQ(refined.size(), 12u);
    EXPECT_LT(largest_error(board, refined), 0.05) << square_px;
    for (const BoardCorner& corner : refined) EXPECT_LT(corner.sigma_px, 0.04) << square_px;
  }
}

TEST(CornerRefinement, FindsLargeCornersFromFarAway) {
  const auto board = test::placed_chessboard(3, 3, {.square_px = 80, .turn_rad = 0.1});
  const auto refined = refine_corners(test::with_noise(test::render(board), 2, 1), started_beside(board, 13), 3);
  EXPECT_LT(largest_error(board, refined), 0.02);
}

TEST(CornerRefinement, ClaimsNoMoreThanItsFloor) {
  const auto board = test::placed_chessboard(3, 3, {});
  for (const BoardCorner& corner : refine_corners(test::render(board), started_beside(board, 1), 3)) {
    EXPECT_EQ(corner.sigma_px, 0.02);
  }
}

TEST(CornerRefinement, LooksNoFartherThanItsWindow) {
  // Marks in the middle of the squares, 0.4 to 0.6 squares from the edges.
  const auto board = test::placed_chessboard(4, 3, {.square_px = 30});
  const cv::Mat image = test::render(board);
  cv::Mat marked = image.clone();
  for (const Vector2d& corner : test::true_corners(board)) {
    const Vector2d low = corner.array() + 0.41 * 30, high = corner.array() + 0.59 * 30;
    cv::rectangle(marked, {cvCeil(low.x()), cvCeil(low.y())}, {cvFloor(high.x()), cvFloor(high.y())}, cv::Scalar(128),
                  cv::FILLED);
  }
  const auto plain = refine_corners(image, started_beside(board, 0.1), 4);
  const auto beside_marks = refine_corners(marked, started_beside(board, 0.1), 4);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(beside_marks[i].pixel, plain[i].pixel);
}

TEST(CornerRefinement, SeesMotionBlurOnLargeSquares) {
  const auto board = test::placed_chessboard(3, 3, {.square_px = 60, .turn_rad = 0.1});
  const auto refined = refine_corners(test::with_noise(test::render(board, {5, 1}), 2, 1), started_beside(board, 3), 3);
  EXPECT_LT(largest_error(board, refined), 0.05);
}

TEST(CornerRefinement, LeavesOutWhatHasNoNeighbourInItsRowOrColumn) {
  const auto board = test::placed_chessboard(4, 3, {});
  auto corners = started_beside(board, 0.5);
  corners.erase(corners.begin() + 1);  // corner 0 keeps none in its row
  const auto refined = refine_corners(test::render(board), corners, 4);
  ASSERT_EQ(refined.size(), 10u);
  EXPECT_EQ(refined.front().id, 2);
  EXPECT_EQ(refined.back().id, 11);
  EXPECT_LT(largest_error(board, refined), 0.02);
}

TEST(CornerRefinement, SaysWhereItCouldNotFit) {
  const auto board = test::placed_chessboard(4, 3, {});
  cv::Mat image = test::with_noise(test::render(board), 2, 1);
  const Vector2d hidden = test::true_corners(board)[5];
  cv::circle(image, {cvRound(hidden.x()), cvRound(hidden.y())}, 18, cv::Scalar(128), cv::FILLED);
  const auto refined = refine_corners(image, started_beside(board, 0.5), 4);
  ASSERT_EQ(refined.size(), 12u);
  for (const BoardCorner& corner : refined) EXPECT_EQ(corner.sigma_px == 0.3, corner.id == 5) << corner.id;
}

TEST(CornerRefinement, KeepsStartsOutsideTheImage) {
  const cv::Mat image(8, 8, CV_8UC1, cv::Scalar(100));
  const std::vector<BoardCorner> corners{{0, {-9, 2}}, {1, {-3, 2}}, {3, {-9, 8}}, {4, {-3, 8}}};
  const auto refined = refine_corners(image, corners, 3);
  ASSERT_EQ(refined.size(), 4u);
  EXPECT_EQ(refined[0].pixel, corners[0].pixel);
  EXPECT_EQ(refined[0].sigma_px, 0.3);
}

TEST(CornerRefinement, RefusesImpossibleInput) {
  const cv::Mat image(80, 80, CV_8UC1, cv::Scalar(100));
  EXPECT_THROW(refine_corners(image, {}, 0), std::invalid_argument);
  EXPECT_THROW(refine_corners(image, std::vector<BoardCorner>{{0, {NAN, 1}}}, 3), std::invalid_argument);
  EXPECT_THROW(validate(CornerRefinementOptions{.half_width = 1.5}), std::invalid_argument);
  EXPECT_THROW(validate(CornerRefinementOptions{.most_half_width_px = 1}), std::invalid_argument);
  EXPECT_THROW(validate(CornerRefinementOptions{.least_sigma_px = 0}), std::invalid_argument);
  EXPECT_THROW(validate(CornerRefinementOptions{.unfitted_sigma_px = 0.01}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
