// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/board_turns.h"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "tests/calib/simulated_films.h"

namespace alidade {
namespace {

using namespace test;

// The true poses in a camera's own clock.
PlacedFilm true_poses(const BundleCamera& camera, const HandMotion& motion, const SimulatedFilm& film) {
  PlacedFilm placed;
  for (double t = film.start_s; t < film.start_s + film.duration_s; t += 1 / film.rate_hz) {
    placed.time_s.push_back(t - film.offset_s);
    placed.T_camera_board.push_back(camera.T_rig_camera.inverse() * motion.T_rig_board(t));
  }
  return placed;
}

TEST(BoardTurns, ASteadyTurnHasItsRate) {
  PlacedFilm film;
  for (int i = 0; i < 5; ++i) {
    film.time_s.push_back(0.1 * i);
    film.T_camera_board.emplace_back(Eigen::Isometry3d::Identity());
    film.T_camera_board.back().linear() = exp_so3({0, 0.03 * i, 0});
  }
  film.time_s.back() += 1.0;
  const auto rates = turn_rates(film, 0.3);
  ASSERT_EQ(rates.size(), 3U);
  EXPECT_NEAR(rates[1].time_s, 0.15, 1e-12);
  EXPECT_NEAR(rates[1].rate_rad_s, 0.3, 1e-9);
  EXPECT_NEAR(turn_range_rad(film), 0.09, 1e-9);
}

TEST(BoardTurns, MatchesFilmsOfTheSameMotion) {
  const auto cameras = filming_cameras();
  const HandMotion motion(3);
  const PlacedFilm first = true_poses(cameras[0], motion, {0, 14, 15, 0});
  const PlacedFilm second = true_poses(cameras[1], motion, {2, 14, 12.5, 7.25});
  const auto matches = match_turns(turn_rates(first, 0.3), turn_rates(second, 0.3));
  ASSERT_FALSE(matches.empty());
  EXPECT_NEAR(matches[0].offset_s, 7.25, 0.03);
  EXPECT_GT(matches[0].correlation, 0.98);
  EXPECT_NEAR(matches[0].overlap_s, 12, 0.5);
  for (std::size_t i = 1; i < matches.size(); ++i) {
    EXPECT_GE(std::abs(matches[i].offset_s - matches[0].offset_s), 0.2 - 1e-9);
  }
}

TEST(BoardTurns, TheRightOffsetLetsTheMomentsAgreeOnThePose) {
  const auto cameras = filming_cameras();
  const HandMotion motion(4);
  const PlacedFilm first = true_poses(cameras[0], motion, {0, 10, 15, 0});
  const PlacedFilm second = true_poses(cameras[1], motion, {0, 10, 12.5, -3});
  const auto right = agree_on_pose(first, second, -3.0, 0.3);
  ASSERT_TRUE(right);
  EXPECT_GT(right->share, 0.98);
  EXPECT_LT((right->T_first_second.translation() - cameras[1].T_rig_camera.translation()).norm(), 0.01);
  const auto wrong = agree_on_pose(first, second, -2.0, 0.3);
  ASSERT_TRUE(wrong);
  EXPECT_LT(wrong->share, 0.5);
  EXPECT_FALSE(agree_on_pose(first, second, 20.0, 0.3));
}

TEST(BoardTurns, PlacesTheBoardAsOftenAsAsked) {
  const CameraFilm film = simulate_film(filming_cameras()[0], HandMotion(5), {0, 2, 30}, 1);
  const PlacedFilm placed = place_film(film, shape_of(filmed_chessboard()), {}, 0.19);
  ASSERT_EQ(placed.time_s.size(), 10U);
  EXPECT_NEAR(placed.time_s[1], 0.2, 1e-9);
  EXPECT_LT((placed.T_camera_board[1].translation() - HandMotion(5).T_rig_board(0.2).translation()).norm(), 0.01);
}

}  // namespace
}  // namespace alidade
