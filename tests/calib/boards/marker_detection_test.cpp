// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/marker_detection.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/calib/boards/board_pictures.h"

namespace alidade {
namespace {

using test::good_light;
using test::picture;

// Bounds on all corners of some images: how many are found, how far off they are, and whether they know it.
void expect_found(const std::string& text, double least_share, double most_px) {
  const auto pictures = picture(text, 4, good_light());
  for (std::size_t i = 0; i < pictures.images.size(); ++i) {
    const auto view = detect_markers_board(pictures.images[i], pictures.board);
    ASSERT_TRUE(view) << text << ", image " << i;
    EXPECT_GE(static_cast<double>(view->corners.size()), least_share * corner_count(pictures.board)) << text << i;
    EXPECT_TRUE(std::ranges::is_sorted(view->corners, std::ranges::less_equal{}, &BoardCorner::id));
    const auto errors = pictures.errors(i, *view);
    EXPECT_LT(errors.rms_px, most_px) << text << ", image " << i;
    EXPECT_LT(errors.over_sigma, 2.0) << text << ", image " << i;
  }
}

TEST(CharucoDetection, FindsTheCornersOfBothLayouts) {
  expect_found("charuco:7x5:30mm:18mm:4X4_50", 0.75, 0.06);
  expect_found("charuco:8x6:30mm:18mm:5X5_100:marker-first", 0.9, 0.06);
}

TEST(CharucoDetection, SeesPartsOfBoards) {
  BoardPoseOptions partial;
  partial.partial = true;
  partial.most_fill = 1.2;
  partial.least_fill = 1.0;
  const auto pictures = picture("charuco:8x6:30mm:18mm:5X5_100", 3, good_light(), partial);
  for (std::size_t i = 0; i < pictures.images.size(); ++i) {
    const auto view = detect_markers_board(pictures.images[i], pictures.board);
    ASSERT_TRUE(view) << i;
    EXPECT_LT(view->corners.size(), 35u);
    EXPECT_GT(view->corners.size(), 8u);
    EXPECT_LT(pictures.errors(i, *view).over_sigma, 2.0) << i;
  }
}

TEST(CharucoDetection, RefusesTheOtherLayout) {
  auto pictures = picture("charuco:8x6:30mm:18mm:5X5_100", 1, good_light());
  EXPECT_EQ(find_charuco_layout(pictures.images[0], pictures.board), CharucoLayout::BlackFirst);
  pictures.board.layout = CharucoLayout::MarkerFirst;
  EXPECT_EQ(find_charuco_layout(pictures.images[0], pictures.board), CharucoLayout::BlackFirst);
  EXPECT_FALSE(detect_markers_board(pictures.images[0], pictures.board));
}

TEST(CharucoDetection, FindsTheLayoutThatStartsWithAMarker) {
  const auto pictures = picture("charuco:8x6:30mm:18mm:5X5_100:marker-first", 1, good_light());
  Board board = pictures.board;
  board.layout = CharucoLayout::BlackFirst;
  EXPECT_EQ(find_charuco_layout(pictures.images[0], board), CharucoLayout::MarkerFirst);
  EXPECT_FALSE(find_charuco_layout(cv::Mat(480, 640, CV_8UC1, cv::Scalar(128)), board));
}

TEST(AprilGridDetection, FindsTheCornersOfTheTags) {
  expect_found("aprilgrid:4x3:40mm:10mm", 0.7, 0.08);
  expect_found("aprilgrid:6x6:24mm:6mm", 0.8, 0.3);
}

// Kalibr counts the rows from the bottom: seen from below, its board is the mirror image of one that counts as ours.
// So the numbering of the whole board is turned by giving each tag the place of its mirror image.
TEST(AprilGridDetection, FindsTheNumberingOfKalibr) {
  const Board board = parse_board("aprilgrid:4x3:40mm:10mm");
  const BoardDrawing drawing = draw_board(board, 3000, 0.01);
  cv::Mat kalibr = drawing.image.clone();
  const int step = 150, start = static_cast<int>(drawing.origin_px.x() + 0.5);
  for (int row = 0; row < 3; ++row) {
    const cv::Rect from(start, start + (2 - row) * step, 4 * step - 30, 120);
    drawing.image(from).copyTo(kalibr(cv::Rect(start, start + row * step, 4 * step - 30, 120)));
  }
  cv::GaussianBlur(kalibr, kalibr, {}, 1.0);
  const auto view = detect_markers_board(kalibr, board);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->corners.size(), 48u);
  const auto corners = corners_m(board);
  for (const BoardCorner& corner : view->corners) {
    const Eigen::Vector2d p = corners[static_cast<std::size_t>(corner.id)].head<2>();
    EXPECT_LT((corner.pixel - drawing.origin_px - 3000 * p).norm(), 0.1) << corner.id;
  }
}

TEST(MarkersBoardDetection, FindsNothingInAnEmptyScene) {
  const cv::Mat grey(480, 640, CV_8UC1, cv::Scalar(180));
  EXPECT_FALSE(detect_markers_board(grey, parse_board("charuco:8x6:30mm:18mm:5X5_100")));
  EXPECT_FALSE(detect_markers_board(grey, parse_board("aprilgrid:4x3:40mm:10mm")));
}

TEST(MarkersBoardDetection, RefusesChessboardsAndColour) {
  const cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(180)), colour(48, 64, CV_8UC3, cv::Scalar::all(180));
  EXPECT_THROW(detect_markers_board(grey, Board{}), std::invalid_argument);
  EXPECT_THROW(detect_markers_board(colour, parse_board("aprilgrid:4x3:40mm:10mm")), std::invalid_argument);
  EXPECT_THROW(find_charuco_layout(grey, Board{}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
