// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_guess.h"

#include <gtest/gtest.h>

#include "tests/calib/boards/board_pictures.h"

namespace alidade {
namespace {

Board guessed(const std::string& text) {
  const auto pictures = test::picture(text, 1, test::good_light());
  const auto guess = guess_board(pictures.images);
  EXPECT_TRUE(guess) << text;
  if (!guess) return {};
  EXPECT_TRUE(guess->scale_is_assumed);
  return guess->board;
}

// All but the share of the markers, which must be near.
void expect_guessed(const std::string& text, const std::string& dictionary) {
  const Board truth = parse_board(text), guess = guessed(text);
  EXPECT_EQ(guess.kind, truth.kind) << text;
  EXPECT_EQ(guess.columns, truth.columns) << text;
  EXPECT_EQ(guess.rows, truth.rows) << text;
  EXPECT_EQ(guess.layout, truth.layout) << text;
  EXPECT_EQ(guess.dictionary, dictionary) << text;
  EXPECT_EQ(guess.square_m, 0.025) << text;
  EXPECT_NEAR(guess.marker_m / guess.square_m, truth.marker_m / truth.square_m, 0.03) << text;
  EXPECT_NEAR(guess.gap_m / guess.square_m, truth.gap_m / truth.square_m, 0.03) << text;
}

TEST(BoardGuess, TellsBothLayoutsOfCharucoBoards) {
  expect_guessed("charuco:8x6:30mm:20mm:5X5_100", "5X5_50");
  expect_guessed("charuco:8x6:30mm:22mm:4X4_1000:marker-first", "4X4_50");
}

TEST(BoardGuess, TellsAprilGrids) {
  expect_guessed("aprilgrid:4x3:40mm:10mm", "APRILTAG_36h11");
}

TEST(BoardGuess, TellsChessboards) {
  expect_guessed("chessboard:9x6:30mm", "");
}

TEST(BoardGuess, TellsNoneWhereThereIsNone) {
  const std::vector<cv::Mat> greys{cv::Mat(240, 320, CV_8UC1, cv::Scalar(150))};
  EXPECT_FALSE(guess_board(greys));
  EXPECT_FALSE(guess_board({}));
  const std::vector<cv::Mat> colour{cv::Mat(24, 32, CV_8UC3, cv::Scalar::all(150))};
  EXPECT_THROW(guess_board(colour), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
