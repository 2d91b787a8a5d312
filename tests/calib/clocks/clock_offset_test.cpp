// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/clock_offset.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/calib/simulated_films.h"

namespace alidade {
namespace {

using namespace test;
using Outcome = ClockOffsetOutcome;

ClockOffset find(const HandMotion& motion, const SimulatedFilm& first, const SimulatedFilm& second, unsigned seed) {
  const auto cameras = filming_cameras();
  return find_clock_offset({shape_of(filmed_chessboard())}, simulate_film(cameras[0], motion, first, 2 * seed),
                           simulate_film(cameras[1], motion, second, 2 * seed + 1));
}

TEST(ClockOffset, IsFoundFromFilmsOfUnlikeRates) {
  for (const double offset_s : {1.2345, -17.6}) {
    SCOPED_TRACE(offset_s);
    const ClockOffset found = find(HandMotion(11), {0, 9, 30, 0}, {1.7, 9, 25, offset_s}, 11);
    ASSERT_EQ(found.outcome, Outcome::Found) << explain(found.outcome);
    EXPECT_LT(found.sigma_s, 2e-4);
    EXPECT_LT(std::abs(found.offset_s - offset_s), 4 * found.sigma_s);
    EXPECT_LT(std::abs(found.offset_s - offset_s), 1e-3);
    const Vector6d error = difference(filming_cameras()[1].T_rig_camera, found.T_first_second);
    for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(error[i]), 4 * std::sqrt(found.pose_covariance(i, i))) << i;
    EXPECT_LT(found.rms_px, 0.2);
  }
}

TEST(ClockOffset, IsNotFoundFromABoardAtRest) {
  const ClockOffset found = find(HandMotion(12, 0.0), {0, 5, 15, 0}, {0, 5, 15, 1.2345}, 12);
  EXPECT_EQ(found.outcome, Outcome::HardlyMoves);
  EXPECT_NE(explain(found.outcome).find("turn it"), std::string::npos);
}

TEST(ClockOffset, IsNotFoundFromFilmsThatDoNotOverlap) {
  for (unsigned seed = 13; seed < 16; ++seed) {
    SCOPED_TRACE(seed);
    const ClockOffset found = find(HandMotion(seed), {0, 8, 20, 0}, {30, 8, 20, 1.2345}, seed);
    EXPECT_EQ(found.outcome, Outcome::NoCommonMotion) << found.offset_s;
  }
}

// A pendulum of 2 s: every swing looks like the one before.
TEST(ClockOffset, IsNotFoundFromMotionThatRepeatsItself) {
  const auto swinging = [](const BundleCamera& camera, const SimulatedFilm& film, unsigned seed) {
    const CameraFilm once = simulate_film(camera, HandMotion(16), {film.start_s, 2, film.rate_hz, 0}, seed);
    std::vector<BoardView> views;
    for (int i = 0; i < 5; ++i) {
      for (BoardView view : once.film.views()) {
        view.time_s += 2.0 * i;
        view.frame += static_cast<int>(2 * film.rate_hz) * i;
        views.push_back(std::move(view));
      }
    }
    return CameraFilm{camera.camera, BoardFilm(std::move(views))};
  };
  const auto cameras = filming_cameras();
  const ClockOffset found = find_clock_offset({shape_of(filmed_chessboard())}, swinging(cameras[0], {0, 10, 20}, 1),
                                              swinging(cameras[1], {0, 10, 20}, 2));
  EXPECT_EQ(found.outcome, Outcome::Ambiguous) << found.offset_s;
}

TEST(ClockOffset, IsNotFoundFromFewViews) {
  EXPECT_EQ(find(HandMotion(14), {0, 9, 20, 0}, {0, 0.5, 20, 0}, 14).outcome, Outcome::TooFewViews);
}

TEST(ClockOffset, RefusesImpossibleOptions) {
  ClockOffsetOptions options;
  options.least_share = 1.5;
  try {
    validate(options);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "least_share must be in (0, 1], got 1.5");
  }
}

}  // namespace
}  // namespace alidade
