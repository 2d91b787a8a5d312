// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/board_film.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

using test::RandomGeometry;

// Two corners that move along a cubic, which four views determine.
BoardView cubic_view(double t) {
  const Eigen::Vector2d pixel(100 + 20 * t - 3 * t * t + 7 * t * t * t, 50 - 5 * t + t * t * t);
  return {"at " + std::to_string(t), static_cast<int>(t * 10), t, {{3, pixel}, {8, pixel + Eigen::Vector2d(9, 0)}}};
}

BoardFilm cubic_film(int frames) {
  std::vector<BoardView> views;
  for (int i = 0; i < frames; ++i) views.push_back(cubic_view(0.1 * i));
  return BoardFilm(std::move(views));
}

TEST(BoardFilm, FollowsACubicWithItsVelocity) {
  const BoardFilm film = cubic_film(12);
  for (const double t : {0.1, 0.32, 0.5, 0.777}) {
    const auto moment = film.at(t);
    ASSERT_TRUE(moment.has_value()) << t;
    ASSERT_EQ(moment->view.corners.size(), 2U);
    EXPECT_EQ(moment->view.corners[1].id, 8);
    EXPECT_NEAR((moment->view.corners[0].pixel - cubic_view(t).corners[0].pixel).norm(), 0, 1e-10);
    EXPECT_NEAR(moment->motion[0].velocity_px_s.x(), 20 - 6 * t + 21 * t * t, 1e-8);
    EXPECT_NEAR(moment->motion[0].velocity_px_s.y(), -5 + 3 * t * t, 1e-8);
  }
}

TEST(BoardFilm, TellsHowTheVarianceChanges) {
  const BoardFilm film = cubic_film(12);  // of sigma_px 0.1
  const auto variance = [&](double t) { return std::pow(film.at(t)->view.corners[0].sigma_px, 2); };
  EXPECT_NEAR(film.at(0.55)->motion[0].variance_rate_px2_s, 0, 1e-12);
  for (const double t : {0.51, 0.58}) {
    const double slope = (variance(t + 1e-5) - variance(t - 1e-5)) / 2e-5;
    EXPECT_NEAR(film.at(t)->motion[0].variance_rate_px2_s, slope, 1e-6);
    EXPECT_GT(std::abs(slope), 0.01);
  }
}

TEST(BoardFilm, NamesTheNearestFrame) {
  EXPECT_EQ(cubic_film(12).at(0.46)->view.name, "at " + std::to_string(0.5));
  EXPECT_EQ(cubic_film(12).at(0.46)->first, 3);
}

TEST(BoardFilm, KnowsNothingAtItsEndsAndAcrossGaps) {
  EXPECT_FALSE(cubic_film(12).at(0.05));
  EXPECT_FALSE(cubic_film(12).at(1.06));
  EXPECT_FALSE(cubic_film(3).at(0.15));
  std::vector<BoardView> views = cubic_film(12).views();
  views.erase(views.begin() + 5);
  const BoardFilm film(views);
  EXPECT_FALSE(film.at(0.42));
  EXPECT_FALSE(film.at(0.35));
  EXPECT_TRUE(film.at(0.25));
}

TEST(BoardFilm, LeavesOutCornersThatAViewLacks) {
  std::vector<BoardView> views = cubic_film(12).views();
  views[4].corners.pop_back();
  ASSERT_EQ(BoardFilm(views).at(0.55)->view.corners.size(), 1U);
  EXPECT_EQ(BoardFilm(views).at(0.75)->view.corners.size(), 2U);
}

TEST(BoardFilm, RefusesTimesThatDoNotIncrease) {
  EXPECT_THROW(BoardFilm({cubic_view(0.2), cubic_view(0.1)}), std::invalid_argument);
}

// The stated sigma is that of the error, be it noise (slow) or the cubic's (fast).
TEST(BoardFilm, StatesTheErrorOfItsCorners) {
  for (const double frequency_rad_s : {1.0, 40.0}) {
    SCOPED_TRACE(frequency_rad_s);
    RandomGeometry random(5);
    const auto pixel = [&](double t) { return 300 + 20 * std::sin(frequency_rad_s * t); };
    std::vector<BoardView> views;
    for (int i = 0; i < 400; ++i) {
      BoardView view{"", i, 0.04 * i, {}};
      for (int id = 0; id < 6; ++id) {
        view.corners.push_back({id, {pixel(view.time_s) + random.normal(0.1), random.normal(0.1)}});
      }
      views.push_back(std::move(view));
    }
    const BoardFilm film(std::move(views));
    double squares = 0, stated = 0;
    for (double t = 1.02; t < 15; t += 0.04) {
      const auto moment = film.at(t);
      for (const BoardCorner& corner : moment->view.corners) {
        squares += 0.5 * (corner.pixel - Eigen::Vector2d(pixel(t), 0)).squaredNorm();
        stated += corner.sigma_px * corner.sigma_px;
      }
    }
    EXPECT_GT(stated / squares, 0.85);
    EXPECT_LT(stated / squares, 3.0);
  }
}

}  // namespace
}  // namespace alidade
