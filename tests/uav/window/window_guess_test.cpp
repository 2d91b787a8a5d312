// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_guess.h"

#include <chrono>

#include <gtest/gtest.h>

#include "tests/uav/flown_scene.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

struct Flight {
  TargetScene scene;
  std::vector<Bearing> bearings;
  BearingWindow window;

  // The bearing by a receiver in a period.
  std::size_t at(int receiver, int period) const {
    for (std::size_t i = 0; i < bearings.size(); ++i) {
      const auto since = bearings[i].time - Timestamp(period * 1s);
      if (bearings[i].receiver == receiver && since >= 0s && since < 1s) return i;
    }
    return bearings.size();
  }

  double error_m(const MotionGuess& guess, double t_s) const {
    const double u = (t_s - guess.t0_s) / (guess.t1_s - guess.t0_s);
    const Eigen::Vector3d p = guess.p0 + u * (guess.p1 - guess.p0) + window.frame.anchor_world;
    return (p - position_at(scene.paths[0], window.frame.reference + from_seconds(t_s))).norm();
  }
};

Flight fly(unsigned seed, double sigma_m, int receivers = 3) {
  TargetSceneOptions options;
  options.targets = 1;
  options.seed = seed;
  options.sigma_m = sigma_m;
  options.receivers = receivers;
  Flight flight{make_target_scene(options), {}, {}};
  flight.bearings = bearings_of(flight.scene);
  flight.window = prepare_window(flight.bearings, {});
  return flight;
}

TEST(MotionGuess, OfThreeExactBearingsIsExact) {
  const Flight flight = fly(3, 0.0);
  const auto guess = guess_of_three(flight.window, {flight.at(0, 0), flight.at(1, 2), flight.at(2, 4)});
  ASSERT_TRUE(guess);
  for (double t_s : {-2.0, 0.3, 1.7}) EXPECT_LT(flight.error_m(*guess, t_s), 1e-5);
}

TEST(MotionGuess, OfTwoPairsIsExactButForItsLastPass) {
  const Flight flight = fly(4, 0.0, 2);
  for (Bearing bearing : flight.bearings) EXPECT_GT(bearing.covariance(0, 0), 0.0);
  Flight coarse = flight;  // sigma of the gate as with noise
  coarse.window.sigma_rad.assign(coarse.window.sigma_rad.size(), 1e-3);
  const auto guess =
      guess_of_pairs(coarse.window, {flight.at(0, 0), flight.at(1, 0), flight.at(0, 4), flight.at(1, 4)});
  ASSERT_TRUE(guess);
  for (double t_s : {-2.0, 0.3, 1.7}) EXPECT_LT(flight.error_m(*guess, t_s), 1e-3);
}

TEST(MotionGuess, ErrsAsItSays) {
  double squared = 0.0, stated = 0.0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Flight flight = fly(seed, 0.1);
    const auto guess = guess_of_three(flight.window, {flight.at(0, 0), flight.at(1, 2), flight.at(2, 4)});
    if (!guess) continue;
    squared += std::pow(flight.error_m(*guess, guess->t0_s), 2);
    stated += 3.0 * guess->variance0_m2;
  }
  EXPECT_LT(squared, 1.3 * stated);
  EXPECT_GT(squared, 0.1 * stated);
}

TEST(MotionGuess, NeedsThreeMoments) {
  const Flight flight = fly(3, 0.0);
  EXPECT_FALSE(guess_of_three(flight.window, {flight.at(0, 0), flight.at(0, 0), flight.at(2, 4)}));
  EXPECT_FALSE(guess_of_pairs(flight.window, {flight.at(0, 2), flight.at(1, 2), flight.at(0, 2), flight.at(1, 2)}));
}

TEST(MotionGuess, IsNoFasterThanTargetsFly) {
  const Flight flight = fly(3, 0.0);
  Flight slow = flight;
  slow.window.options.top_speed_m_s = 0.5 * flight.scene.paths[0].v_world.norm();
  EXPECT_FALSE(guess_of_three(slow.window, {flight.at(0, 0), flight.at(1, 2), flight.at(2, 4)}));
}

TEST(LinesOfSight, MeetAsFarAsATargetFliesBetweenThem) {
  const Flight flight = fly(5, 0.1);
  EXPECT_TRUE(may_meet(flight.window, flight.at(0, 2), flight.at(1, 2)));
  Flight moved = flight;
  const std::size_t second = flight.at(1, 2);
  const Eigen::Vector3d normal =
      moved.window.rows[flight.at(0, 2)].direction.cross(moved.window.rows[second].direction).normalized();
  moved.window.rows[second].origin += 20.0 * normal;
  EXPECT_FALSE(may_meet(moved.window, flight.at(0, 2), second));
}

TEST(Support, ComesFromTheTargetsOwnBearingsAlone) {
  const Flight flight = fly(6, 0.1);
  const auto guess = guess_of_three(flight.window, {flight.at(0, 0), flight.at(1, 2), flight.at(2, 4)});
  ASSERT_TRUE(guess);
  std::vector<std::size_t> scans;
  for (std::size_t s = 0; s < flight.window.scans.size(); ++s) scans.push_back(s);
  std::vector<char> is_free(flight.bearings.size(), 1);
  const auto support = find_support(flight.window, *guess, scans, {is_free, 0.2, -4.0, 2.0});
  ASSERT_TRUE(support);
  EXPECT_EQ(support->bearings.size(), 15u);
  EXPECT_NEAR(support->log_ratio, 15.0 * std::log(0.9 / 0.2), 1e-9);
  is_free.assign(is_free.size(), 0);
  EXPECT_FALSE(find_support(flight.window, *guess, scans, {is_free, 0.2, -4.0, 2.0}));
}

}  // namespace
}  // namespace alidade
