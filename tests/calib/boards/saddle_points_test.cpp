// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/saddle_points.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/rendered_chessboard.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

// The saddle point nearest to a place, if it is within a pixel.
const SaddlePoint* find_near(const std::vector<SaddlePoint>& points, const Vector2d& place) {
  for (const SaddlePoint& point : points) {
    if ((point.pixel - place).norm() < 1) return &point;
  }
  return nullptr;
}

TEST(SaddlePoints, LieAtTheCornersOfAChessboardSmallAndLarge) {
  for (const double square_px : {5.0, 7.0, 24.0}) {
    const auto board = test::placed_chessboard(6, 5, {.square_px = square_px, .turn_rad = 0.3});
    const auto points = find_saddle_points(test::with_noise(test::render(board), 2, 1));
    for (const Vector2d& corner : test::true_corners(board)) EXPECT_TRUE(find_near(points, corner)) << square_px;
  }
}

TEST(SaddlePoints, TurnFromTheFirstEdgeToTheSecondOverBrightPixels) {
  const auto board = test::placed_chessboard(6, 5, {.square_px = 24, .turn_rad = 0.3});
  const auto points = find_saddle_points(test::render(board));
  const auto corners = test::true_corners(board);
  const SaddlePoint *first = find_near(points, corners[0]), *second = find_near(points, corners[1]);
  ASSERT_TRUE(first && second);
  const double x_rad = 0.3, y_rad = 0.3 + std::numbers::pi / 2;  // the square inside corner 0 is dark
  EXPECT_NEAR(first->edges_rad[0], y_rad, 0.05);
  EXPECT_NEAR(first->edges_rad[1], x_rad, 0.05);
  EXPECT_NEAR(second->edges_rad[0], x_rad, 0.05);
  EXPECT_NEAR(second->edges_rad[1], y_rad, 0.05);
}

TEST(SaddlePoints, LieUpToTheBorderOfTheImage) {
  cv::Mat image(40, 60, CV_8UC1, cv::Scalar(30));
  image(cv::Rect(0, 0, 30, 4)).setTo(200);
  image(cv::Rect(30, 4, 30, 36)).setTo(200);
  cv::GaussianBlur(image, image, {}, 0.7, 0.7, cv::BORDER_REPLICATE);
  const auto points = find_saddle_points(image);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_LT((points[0].pixel - Vector2d(29.5, 3.5)).norm(), 0.3);
}

TEST(SaddlePoints, AreNoEdgesNoSpotsAndNoPlainWalls) {
  cv::Mat image(80, 80, CV_8UC1, cv::Scalar(100));
  EXPECT_TRUE(find_saddle_points(image).empty());
  image(cv::Rect(0, 0, 80, 30)).setTo(200);
  cv::circle(image, {40, 60}, 6, cv::Scalar(220), cv::FILLED);
  EXPECT_TRUE(find_saddle_points(image).empty());
}

TEST(SaddlePoints, ComeStrongestFirst) {
  const auto board = test::placed_chessboard(6, 5, {.square_px = 24, .tilt = {0.05, 0}});
  const auto points = find_saddle_points(test::render(board));
  EXPECT_TRUE(std::ranges::is_sorted(points, std::ranges::greater{}, &SaddlePoint::strength));
}

TEST(SaddlePoints, AngleBetweenLinesTurnsNoFurtherThanAQuarter) {
  EXPECT_NEAR(angle_between_lines(0.1, 3.1), std::numbers::pi - 3.0, 1e-12);
  EXPECT_NEAR(angle_between_lines(1.2, 0.2), 1.0, 1e-12);
}

TEST(SaddlePoints, RefuseColour) {
  EXPECT_THROW(find_saddle_points(cv::Mat(80, 80, CV_8UC3)), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
