// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/crossing_refinement.h"

#include <gtest/gtest.h>

#include "tests/calib/boards/board_pictures.h"

namespace alidade {
namespace {

// Guesses a pixel off, with the steps of a chessboard's squares.
std::vector<CrossingGuess> guesses(const test::BoardPictures& pictures) {
  const int columns = pictures.board.columns;
  std::vector<CrossingGuess> result;
  for (int id = 0; id + columns < corner_count(pictures.board); ++id) {
    if (id % columns == columns - 1) continue;
    const Eigen::Vector2d pixel = pictures.pixel(0, id);
    result.push_back({id, pixel + Eigen::Vector2d(0.6, -0.5), 0.4 * (pictures.pixel(0, id + 1) - pixel),
                      0.4 * (pictures.pixel(0, id + columns) - pixel), 1.0, 2.0});
  }
  return result;
}

TEST(CrossingRefinement, FindsCrossingsAsWellAsItSays) {
  const auto pictures = test::picture("chessboard:9x6:25mm", 1, test::good_light());
  BoardView view;
  view.corners = refine_crossings(pictures.images[0], guesses(pictures));
  ASSERT_EQ(view.corners.size(), 40u);
  const auto errors = pictures.errors(0, view);
  EXPECT_LT(errors.rms_px, 0.02);
  EXPECT_GT(errors.over_sigma, 0.3);  // the floor of 0.02 px is more than these pictures need
  EXPECT_LT(errors.over_sigma, 1.5);
}

TEST(CrossingRefinement, LeavesOutWhatIsFartherThanSaid) {
  const auto pictures = test::picture("chessboard:9x6:25mm", 1, test::good_light());
  auto all = guesses(pictures);
  for (CrossingGuess& guess : all) guess.within_px = 0.5;
  EXPECT_TRUE(refine_crossings(pictures.images[0], all).empty());
}

TEST(CrossingRefinement, RefusesColour) {
  EXPECT_THROW(refine_crossings(cv::Mat(8, 8, CV_8UC3, cv::Scalar()), {}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
