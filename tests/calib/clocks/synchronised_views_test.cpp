// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/synchronised_views.h"

#include <cmath>

#include <gtest/gtest.h>

#include "calib/bundle/bundle_fit.h"
#include "tests/calib/simulated_films.h"

namespace alidade {
namespace {

using namespace test;

constexpr double kOffset = -4.321;  // s

std::vector<RigCameraViews> films_of(const HandMotion& motion, double second_start_s = 0.0) {
  const auto cameras = filming_cameras();
  const auto first = simulate_film(cameras[0], motion, {0, 8, 20, 0}, 1);
  const auto second = simulate_film(cameras[1], motion, {second_start_s, 8, 15, kOffset}, 2);
  return {{"left", {640, 480}, first.film.views()}, {"right", {640, 480}, second.film.views()}};
}

TEST(SynchronisedViews, AreOfOneMoment) {
  const HandMotion motion(21);
  const auto views = synchronise(films_of(motion), std::vector{0.0, kOffset});
  ASSERT_EQ(views.size(), 2U);
  EXPECT_EQ(views[1].name, "right");
  ASSERT_GT(views[1].views.size(), 8U);
  const auto cameras = filming_cameras();
  const BoardShape shape = shape_of(filmed_chessboard());
  double squares = 0;
  int corners = 0;
  for (int c = 0; c < 2; ++c) {
    for (const BoardView& view : views[static_cast<std::size_t>(c)].views) {
      const BoardBundle truth{cameras, {motion.T_rig_board(view.time_s)}, {}};
      const auto residuals = residuals_px(truth, shape, {c, 0, view.corners, {}});
      for (std::size_t i = 0; i < residuals.size(); ++i, ++corners) {
        squares += 0.5 * residuals[i].squaredNorm() / std::pow(view.corners[i].sigma_px, 2);
      }
    }
  }
  EXPECT_NEAR(squares / corners, 1.0, 0.15);
}

TEST(SynchronisedViews, AreNumberedByMoments) {
  const auto views = synchronise(films_of(HandMotion(22), 5.0), std::vector{0.0, kOffset});
  std::vector<double> time_s(100, -1.0);
  int both = 0;
  for (const RigCameraViews& camera : views) {
    for (std::size_t i = 0; i < camera.views.size(); ++i) {
      double& of_moment = time_s.at(static_cast<std::size_t>(camera.views[i].frame));
      both += of_moment >= 0 ? 1 : 0;
      if (of_moment >= 0) {
        EXPECT_EQ(of_moment, camera.views[i].time_s);
      }
      of_moment = camera.views[i].time_s;
      if (i > 0) {
        EXPECT_GT(camera.views[i].time_s - camera.views[i - 1].time_s, 4.0 / 15 - 1e-9);
      }
    }
  }
  EXPECT_GT(both, 3);
  EXPECT_LT(views[0].views.front().time_s, 5.0);  // the first camera alone
  EXPECT_GT(views[1].views.back().time_s, 8.0);   // the second one
}

TEST(SynchronisedViews, WantAnOffsetPerCamera) {
  EXPECT_THROW(synchronise(films_of(HandMotion(23)), std::vector{0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
