// SPDX-License-Identifier: Apache-2.0
#include "calib/clocks/clock_refinement.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/calib/simulated_films.h"

namespace alidade {
namespace {

using namespace test;

constexpr double kOffset = 1.2345;  // s

struct FilmedPair {
  FilmedBoard board{shape_of(filmed_chessboard())};
  CameraFilm first, second;
  CameraTie truth;
};

FilmedPair film_pair(unsigned seed, double duration_s, double second_hz = 25) {
  const auto cameras = filming_cameras();
  const HandMotion motion(seed);
  return {{shape_of(filmed_chessboard())},
          simulate_film(cameras[0], motion, {0, duration_s, 30, 0}, 2 * seed + 1),
          simulate_film(cameras[1], motion, {0.3, duration_s, second_hz, kOffset}, 2 * seed + 2),
          {kOffset, cameras[1].T_rig_camera}};
}

CameraTie moved(const CameraTie& tie, double seconds, double angle) {
  Vector6d xi;
  xi << 0.01, -0.01, 0.005, angle, -angle, angle;
  return {tie.offset_s + seconds, tie.T_first_second * perturbation(xi)};
}

Eigen::Vector<double, 7> error_of(const RefinedTie& refined, const CameraTie& truth) {
  Eigen::Vector<double, 7> error;
  error << refined.tie.offset_s - truth.offset_s, difference(truth.T_first_second, refined.tie.T_first_second);
  return error;
}

TEST(ClockRefinement, FindsTheTieFromAStartThatIsOff) {
  const FilmedPair pair = film_pair(1, 8);
  for (const double late_s : {-0.06, 0.04}) {
    SCOPED_TRACE(late_s);
    const auto refined = refine_tie(pair.board, pair.first, pair.second, moved(pair.truth, late_s, 0.02));
    ASSERT_TRUE(refined);
    EXPECT_TRUE(refined->converged);
    EXPECT_GT(refined->moments, 40);
    EXPECT_LE(refined->moments, 8 * 25 / 4);  // four frames of the second film for each
    EXPECT_LT(std::abs(refined->tie.offset_s - kOffset), 1e-3);
    EXPECT_NEAR(refined->scale, 1.0, 0.1);
    const auto error = error_of(*refined, pair.truth);
    for (int i = 0; i < 7; ++i) EXPECT_LT(std::abs(error[i]), 4 * std::sqrt(refined->covariance(i, i))) << i;
  }
}

TEST(ClockRefinement, ItsErrorsAreAsLargeAsItStates) {
  constexpr int kTrials = 20;
  ClockRefinementOptions options;
  options.most_moments = 14;
  double offset_nees = 0, nees = 0;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    SCOPED_TRACE(seed);
    const FilmedPair pair = film_pair(seed, 4);
    const auto refined = refine_tie(pair.board, pair.first, pair.second, moved(pair.truth, 0.01, 0.002), options);
    ASSERT_TRUE(refined);
    const auto error = error_of(*refined, pair.truth);
    offset_nees += error[0] * error[0] / refined->covariance(0, 0) / kTrials;
    nees += error.dot(refined->covariance.ldlt().solve(error)) / kTrials;
  }
  // 99.9 % of chi-square with 20 and 140 degrees of freedom, per trial.
  EXPECT_GT(offset_nees, 0.27);
  EXPECT_LT(offset_nees, 2.4);
  EXPECT_GT(nees, 4.5);
  EXPECT_LT(nees, 10.1);
}

// At equal rates the second camera's frames lie at the first one's moments here: noise must not push them apart.
TEST(ClockRefinement, NoiseDoesNotPushFramesApart) {
  constexpr int kTrials = 8;
  double mean_z = 0;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    const FilmedPair pair = film_pair(seed, 8, 30);
    const auto refined = refine_tie(pair.board, pair.first, pair.second, pair.truth);
    ASSERT_TRUE(refined) << seed;
    mean_z += (refined->tie.offset_s - kOffset) / std::sqrt(refined->covariance(0, 0)) / kTrials;
  }
  EXPECT_LT(std::abs(mean_z), 3.3 / std::sqrt(kTrials));  // 99.9 % of a normal mean
}

TEST(ClockRefinement, GrossCornersDoNotMatter) {
  FilmedPair pair = film_pair(2, 8);
  std::vector<BoardView> views = pair.second.film.views();
  for (std::size_t i = 3; i < views.size(); i += 9) views[i].corners[i % 20].pixel.x() += 15;
  pair.second.film = BoardFilm(views);
  const auto refined = refine_tie(pair.board, pair.first, pair.second, moved(pair.truth, 0.02, 0.01));
  ASSERT_TRUE(refined);
  EXPECT_LT(std::abs(refined->tie.offset_s - kOffset), 4 * std::sqrt(refined->covariance(0, 0)));
  EXPECT_LT(refined->rms_px, 0.3);
}

TEST(ClockRefinement, IsEmptyWithoutSharedMoments) {
  const FilmedPair pair = film_pair(3, 2);
  EXPECT_FALSE(refine_tie(pair.board, pair.first, pair.second, moved(pair.truth, 10.0, 0.0)));
}

}  // namespace
}  // namespace alidade
