// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/edge_crossing.h"

#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/support/rendered_chessboard.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

constexpr double kDegree = std::numbers::pi / 180;

// The crossing nearest the middle of a 3x3 board, from `offset` beside it.
CrossingStart start_beside_middle(const test::RenderedChessboard& board, const Vector2d& offset) {
  const auto corners = test::true_corners(board);
  return {
      .pixel = corners[4] + offset, .step_x = (corners[5] - corners[3]) / 2, .step_y = (corners[7] - corners[1]) / 2};
}

test::RenderedChessboard small_image_of(test::BoardPlacement placement) {
  placement.pixel += Vector2d(-120, -80);
  auto board = test::placed_chessboard(3, 3, placement);
  board.width = board.height = 80;
  return board;
}

TEST(EdgeCrossing, IsFoundWithoutBiasAtAnyAngleAndPhase) {
  // Noise-free but for rounding to grey levels: 0.3 / (85 sqrt(20 edge pixels)) is below 0.002 px.
  for (const double turn_deg : {0.0, 10.0, 45.0, 80.0}) {
    for (const Vector2d& phase : {Vector2d(0, 0), Vector2d(0.5, 0.25), Vector2d(0.3, 0.8)}) {
      const auto board = small_image_of({.pixel = Vector2d(160, 120) + phase,
                                         .square_px = 22,
                                         .turn_rad = turn_deg * kDegree,
                                         .tilt = {0.04, -0.02}});
      const auto crossing = fit_edge_crossing(test::render(board), start_beside_middle(board, {0.7, -0.9}));
      ASSERT_TRUE(crossing);
      EXPECT_LT((crossing->pixel - test::true_corners(board)[4]).norm(), 0.01)
          << turn_deg << " deg, " << phase.transpose();
    }
  }
}

TEST(EdgeCrossing, StaysInPlaceWhereTheEdgesAreSlanted) {
  auto board = small_image_of({.pixel = {160.2, 120.4}, .square_px = 26, .turn_rad = 0.3});
  Eigen::Matrix3d squeeze = Eigen::Matrix3d::Identity();
  squeeze(0, 1) = 0.7;  // edges at 55 degrees
  squeeze(0, 2) = -0.7 * 40;
  board.H_pixel_board = squeeze * board.H_pixel_board;
  const auto crossing = fit_edge_crossing(test::render(board, {1.2, 1.2}), start_beside_middle(board, {0.5, 0.5}));
  ASSERT_TRUE(crossing);
  EXPECT_LT((crossing->pixel - test::true_corners(board)[4]).norm(), 0.01);
}

TEST(EdgeCrossing, TellsAnglesBlurAndContrast) {
  const auto board = small_image_of({.square_px = 25, .turn_rad = 20 * kDegree});
  const auto crossing = fit_edge_crossing(test::render(board, {1.5, 1.5}), start_beside_middle(board, {1, 0}));
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->angle_rad[0], 20 * kDegree, 1e-3);
  EXPECT_NEAR(crossing->angle_rad[1], 110 * kDegree, 1e-3);
  // variances add: the Gaussian's, the pixel's 1/12 and what the rendering's ramps and samples add, below 0.03
  for (const double blur : crossing->blur_px) EXPECT_NEAR(blur * blur, 1.5 * 1.5 + 1.0 / 12, 0.06);
  EXPECT_NEAR(crossing->contrast, 85, 1);
}

TEST(EdgeCrossing, TellsTheBlurOfMotionAlongOneEdgeOnly) {
  const auto board = small_image_of({.square_px = 30});
  const auto crossing = fit_edge_crossing(test::render(board, {3, 0.8}), start_beside_middle(board, {1, 0.5}));
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->blur_px[0], 0.85, 0.1);  // the edge along x is blurred along y
  EXPECT_NEAR(crossing->blur_px[1], 3.0, 0.1);
  EXPECT_LT((crossing->pixel - test::true_corners(board)[4]).norm(), 0.01);
}

TEST(EdgeCrossing, ErrsAsMuchAsItsCovarianceSays) {
  // The mean NEES of n = 60 trials of 2 coordinates is chi2(120) / 60; its 99.9 % interval is [1.28, 2.90]. The fit has
  // no more information than the pixels hold: its covariance is the Cramér-Rao bound, so this is efficiency as well.
  const auto board = small_image_of({.pixel = {160.3, 120.1}, .square_px = 20, .turn_rad = 0.4, .tilt = {0.03, 0.03}});
  const cv::Mat image = test::render(board);
  constexpr int kTrials = 60;
  double nees = 0;
  Vector2d sum = Vector2d::Zero();
  for (int seed = 1; seed <= kTrials; ++seed) {
    const auto crossing = fit_edge_crossing(test::with_noise(image, 2, seed), start_beside_middle(board, {0.4, 0.6}));
    ASSERT_TRUE(crossing);
    const Vector2d error = crossing->pixel - test::true_corners(board)[4];
    nees += error.dot(crossing->covariance_px2.inverse() * error) / kTrials;
    sum += error;
  }
  EXPECT_GT(nees, 1.28);
  EXPECT_LT(nees, 2.90);
  EXPECT_LT((sum / kTrials).norm(), 0.01);
}

TEST(EdgeCrossing, IsEmptyWithoutEdgesOrPixels) {
  const cv::Mat blank(80, 80, CV_8UC1, cv::Scalar(128));
  const auto noisy = test::with_noise(blank, 2, 1);
  const auto on_blank = fit_edge_crossing(noisy, {.pixel = {40, 40}, .step_x = {25, 0}, .step_y = {0, 25}});
  EXPECT_TRUE(!on_blank || on_blank->covariance_px2.trace() > 0.2);  // an answer that claims nothing
  EXPECT_FALSE(fit_edge_crossing(noisy, {.pixel = {-30, 40}, .step_x = {25, 0}, .step_y = {0, 25}}));
  EXPECT_FALSE(fit_edge_crossing(noisy, {.pixel = {40, 40}, .step_x = {5, 0}, .step_y = {0, 5}}));
}

TEST(EdgeCrossing, RefusesColour) {
  EXPECT_THROW(fit_edge_crossing(cv::Mat(80, 80, CV_8UC3), {}), std::invalid_argument);
}

TEST(CrossingByGradients, StaysWhereNoWindowFits) {
  const cv::Mat grey(6, 40, CV_8UC1, cv::Scalar(90));
  EXPECT_EQ(crossing_by_gradients(grey, {20, 3}, 5), Eigen::Vector2d(20, 3));
  EXPECT_EQ(crossing_by_gradients(cv::Mat(40, 40, CV_8UC1, cv::Scalar(90)), {-1, 3}, 5), Eigen::Vector2d(-1, 3));
}

}  // namespace
}  // namespace alidade
