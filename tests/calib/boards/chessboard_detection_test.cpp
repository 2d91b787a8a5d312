// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/chessboard_detection.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/support/rendered_chessboard.h"

namespace alidade {
namespace {

constexpr Board board_of(int columns, int rows) {
  return {.columns = columns, .rows = rows};
}

TEST(ChessboardDetection, FindsAllCornersToAFewHundredthsOfAPixel) {
  const std::vector<test::BoardPlacement> placements{
      {.square_px = 13, .turn_rad = 0.3},
      {.square_px = 24, .turn_rad = 0.05, .tilt = {0.05, 0}},
      {.square_px = 26, .turn_rad = -0.4, .tilt = {0, 0.08}},
      {.square_px = 22, .turn_rad = 1.3, .tilt = {-0.04, 0.06}},
  };
  for (const auto& placement : placements) {
    const auto board = test::placed_chessboard(6, 5, placement);
    const auto view = detect_chessboard(test::with_noise(test::render(board), 2, 1), board_of(6, 5));
    ASSERT_TRUE(view) << placement.turn_rad;
    ASSERT_EQ(view->corners.size(), 30u);
    const auto truth = test::true_corners(board);
    for (int id = 0; id < 30; ++id) {
      EXPECT_EQ(view->corners[id].id, id);
      EXPECT_LT((view->corners[id].pixel - truth[id]).norm(), 0.05) << placement.turn_rad << ", corner " << id;
    }
  }
}

TEST(ChessboardDetection, IsEmptyWithoutABoard) {
  EXPECT_FALSE(detect_chessboard(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), board_of(6, 5)));
}

TEST(ChessboardDetection, RefusesOtherBoards) {
  const cv::Mat image(80, 80, CV_8UC1, cv::Scalar(128));
  EXPECT_THROW(detect_chessboard(image, Board{.kind = BoardKind::Charuco}), std::invalid_argument);
  EXPECT_THROW(detect_chessboard(image, board_of(2, 5)), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
