// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_tracker.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "tests/uav/flown_scene.h"

namespace alidade {
namespace {

TargetSceneOptions slow_scene(int targets, unsigned seed) {
  TargetSceneOptions options = paper_table_scene(targets, {0.0, 0.1, 0.2}, seed);
  options.velocity_sigma_m_s = 6.0;
  options.row_spacing_m = 60.0;  // lines of sight to two targets pass each other beyond the pair threshold
  return options;
}

double distance_to_nearest(const PaperTarget& target, const TargetScene& scene) {
  double nearest = 1e9;
  for (const TargetPath& path : scene.paths) {
    nearest = std::min(nearest, (position_at(path, target.state.time) - target.state.p_world).norm());
  }
  return nearest;
}

TEST(PaperTracker, ProposedFindsPositionVelocityAndNumber) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const TargetScene scene = make_target_scene(slow_scene(2, seed));
    const auto bearings = bearings_of(scene);
    const auto targets = locate_paper_targets(bearings, {});
    ASSERT_EQ(targets.size(), 2u) << seed;
    for (const PaperTarget& target : targets) {
      EXPECT_LT(distance_to_nearest(target, scene), 1.5) << seed;
      EXPECT_LT((target.state.v_world - scene.paths[0].v_world).norm(), 6.0) << seed;
      EXPECT_EQ(target.state.time, Timestamp(std::chrono::seconds(4)));
      EXPECT_EQ(target.period, 4);
      ASSERT_EQ(target.bearings.size(), 15u);
      const int of = bearings[target.bearings[0]].target;
      for (const std::size_t b : target.bearings) EXPECT_EQ(bearings[b].target, of) << seed;
    }
  }
}

// With orthogonal lines and no noise, r₁ errs by the displacement along the first line of sight: a₁ · V Δt.
TEST(PaperTracker, AlternativeErrsByWhatTheTargetMovesInTheDelay) {
  TargetSceneOptions options = paper_table_scene(1, {0.0, 0.1}, 7);
  options.sigma_m = 0.0;
  options.velocity_sigma_m_s = 2.0;
  const TargetScene scene = make_target_scene(options);
  const auto bearings = bearings_of(scene);
  PaperOptions alternative;
  alternative.method = PaperMethod::Alternative;
  const auto targets = locate_paper_targets(bearings, alternative);
  ASSERT_EQ(targets.size(), 1u);
  const double error = (targets[0].state.p_world - position_at(scene.paths[0], targets[0].state.time)).norm();
  const Bearing& first = bearings[targets[0].bearings[8]];
  ASSERT_EQ(first.receiver, 0);
  EXPECT_NEAR(error, std::abs(scene.paths[0].v_world.dot(first.direction_world)) * 0.1, 0.05);
}

TEST(PaperTracker, DoesNotDependOnTheOrderOfBearingsOrReadTheirTruth) {
  const TargetScene scene = make_target_scene(slow_scene(2, 3));
  auto bearings = bearings_of(scene);
  const auto targets = locate_paper_targets(bearings, {});
  std::mt19937_64 random(1);
  std::shuffle(bearings.begin(), bearings.end(), random);
  for (Bearing& bearing : bearings) bearing.target = -1;
  const auto shuffled = locate_paper_targets(bearings, {});
  ASSERT_EQ(shuffled.size(), targets.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    EXPECT_LT((shuffled[i].state.p_world - targets[i].state.p_world).norm(), 1e-9);
  }
}

TEST(PaperTracker, CarriesIdentitiesFromWindowToWindow) {
  TargetSceneOptions options = slow_scene(2, 2);
  options.periods = 12;
  const TargetScene scene = make_target_scene(options);
  const auto bearings = bearings_of(scene);
  const auto targets = track_paper_targets(bearings, {});
  std::map<int, std::set<int>> truth_of_id;
  std::map<std::int64_t, int> per_period;
  for (const PaperTarget& target : targets) {
    truth_of_id[target.id].insert(bearings[target.bearings.back()].target);
    ++per_period[target.period];
  }
  ASSERT_EQ(per_period.size(), 8u);
  EXPECT_EQ(per_period.begin()->first, 4);
  for (const auto& [period, count] : per_period) EXPECT_EQ(count, 2) << period;
  ASSERT_EQ(truth_of_id.size(), 2u);
  EXPECT_NE(truth_of_id[0], truth_of_id[1]);
}

TEST(PaperTracker, GivesANewIdToWhatComesBack) {
  TargetSceneOptions options = slow_scene(1, 5);
  options.periods = 9;
  auto bearings = bearings_of(make_target_scene(options));
  std::erase_if(bearings, [](const Bearing& b) {
    return b.receiver == 1 && std::floor(to_seconds(b.time.time_since_epoch())) == 4.0;
  });
  PaperOptions paper;
  paper.periods = 3;
  std::map<std::int64_t, int> id_of_period;
  for (const PaperTarget& target : track_paper_targets(bearings, paper)) id_of_period[target.period] = target.id;
  EXPECT_EQ(id_of_period, (std::map<std::int64_t, int>{{2, 0}, {3, 0}, {7, 1}, {8, 1}}));
}

TEST(PaperTracker, HasNoAnswerForTooFewPeriodsOrReceivers) {
  auto bearings = bearings_of(make_target_scene(slow_scene(1, 1)));
  PaperOptions longer;
  longer.periods = 6;
  EXPECT_TRUE(locate_paper_targets(bearings, longer).empty());
  EXPECT_TRUE(track_paper_targets(bearings, longer).empty());
  EXPECT_TRUE(track_paper_targets({}, {}).empty());
  std::erase_if(bearings, [](const Bearing& b) { return b.receiver > 0; });
  for (const auto method : {PaperMethod::Alternative, PaperMethod::Proposed}) {
    PaperOptions options;
    options.method = method;
    EXPECT_TRUE(locate_paper_targets(bearings, options).empty());
  }
}

TEST(PaperTracker, TellsOneSurePositionFromOnePeriod) {
  const TargetScene scene = make_target_scene(slow_scene(1, 1));
  PaperOptions one;
  one.periods = 1;
  const auto targets = track_paper_targets(bearings_of(scene), one);
  ASSERT_EQ(targets.size(), 5u);
  for (const PaperTarget& target : targets) EXPECT_LT(distance_to_nearest(target, scene), 1.5);
}

TEST(PaperTracker, SaysHowUnsureItIsOfLinesOfSightInOnePlane) {
  TargetSceneOptions options = slow_scene(1, 1);
  options.elevation_rad = 0.0;
  options.velocity_sigma_m_s = 0.1;
  for (const PaperTarget& target : locate_paper_targets(bearings_of(make_target_scene(options)), {})) {
    EXPECT_GT(target.state.covariance.trace(), 100.0);
  }
}

}  // namespace
}  // namespace alidade
