// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_drawing.h"

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>

#include "calib/boards/board_text.h"

namespace alidade {
namespace {

int grey_at(const BoardDrawing& drawing, double x_m, double y_m) {
  const Eigen::Vector2d pixel = drawing.origin_px + drawing.pixels_per_m * Eigen::Vector2d(x_m, y_m);
  return drawing.image.at<unsigned char>(static_cast<int>(std::lround(pixel.y())),
                                         static_cast<int>(std::lround(pixel.x())));
}

TEST(BoardDrawing, HasItsOriginBetweenTheFirstFourSquares) {
  const BoardDrawing drawing = draw_board(parse_board("chessboard:4x3:10mm"), 1000, 0.005);
  EXPECT_EQ(drawing.image.size(), cv::Size(60, 50));
  EXPECT_TRUE(drawing.origin_px.isApprox(Eigen::Vector2d(14.5, 14.5)));
  EXPECT_EQ(grey_at(drawing, -0.0006, -0.0006), 0);
  EXPECT_EQ(grey_at(drawing, 0.0006, 0.0006), 0);
  EXPECT_EQ(grey_at(drawing, -0.0006, 0.0006), 255);
  EXPECT_EQ(grey_at(drawing, 0.0006, -0.0006), 255);
}

// A square of 2.5 pixels: the pixel under an edge is half black.
TEST(BoardDrawing, SharesPixelsBetweenBlackAndWhite) {
  const BoardDrawing drawing = draw_board(parse_board("chessboard:4x3:10mm"), 250, 0.008);
  EXPECT_EQ(drawing.image.at<unsigned char>(2, 2), 0);
  EXPECT_NEAR(drawing.image.at<unsigned char>(2, 4), 128, 1);
  EXPECT_EQ(drawing.image.at<unsigned char>(2, 5), 255);
  EXPECT_TRUE(drawing.origin_px.isApprox(Eigen::Vector2d(4.0, 4.0)));
}

// OpenCV 4.6 draws the layout that starts black.
TEST(BoardDrawing, OfACharucoBoardIsThatOfOpenCv) {
  const Board board = parse_board("charuco:8x6:30mm:21mm:5X5_100");
  const BoardDrawing drawing = draw_board(board, 2000, 0);
  const auto reference =
      cv::aruco::CharucoBoard::create(8, 6, 0.03f, 0.021f, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100));
  cv::Mat drawn;
  reference->draw({480, 360}, drawn);
  ASSERT_EQ(drawn.size(), drawing.image.size());
  cv::Mat differing;
  cv::absdiff(drawn, drawing.image, differing);
  // Its markers lie up to a pixel off, as it rounds 9 and 42 pixels its own way.
  EXPECT_LT(cv::countNonZero(differing > 128), 0.05 * 480 * 360);
  EXPECT_EQ(grey_at(drawing, -0.015, -0.015), 0);
}

TEST(BoardDrawing, RefusesAScaleThatIsNone) {
  EXPECT_THROW(draw_board(Board{}, 0, 0), std::invalid_argument);
  EXPECT_THROW(draw_board(Board{}, 100, -1), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
