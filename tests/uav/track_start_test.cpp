// SPDX-License-Identifier: Apache-2.0
#include "uav/track_start.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "datasets/target_scene.h"
#include "uav/known_target.h"
#include "uav/motion_fit.h"

namespace alidade {
namespace {

Timestamp at(double seconds) {
  return Timestamp(from_seconds(seconds));
}

std::vector<Bearing> bearings_until(TargetScene& scene, double seconds) {
  std::vector<Bearing> bearings = bearings_of(scene.receivers, scene.readings);
  std::erase_if(bearings, [&](const Bearing& b) { return b.time > at(seconds); });
  return bearings;
}

TEST(TrackStart, NeedsSightingsOfThreeLooks) {
  const TargetTrackerOptions options;
  EXPECT_TRUE(has_sightings_to_start(8, at(0), at(2.1), options));
  EXPECT_FALSE(has_sightings_to_start(7, at(0), at(2.1), options));
  EXPECT_FALSE(has_sightings_to_start(12, at(0), at(1.2), options));
  EXPECT_TRUE(has_sightings_to_start(6, at(0), at(3.1), options));
  EXPECT_FALSE(has_sightings_to_start(5, at(0), at(3.1), options));
}

TEST(TrackStart, StartsEachTargetOnceAndKeepsTheRest) {
  TargetSceneOptions scene_options;
  scene_options.targets = 3;
  scene_options.false_bearings = 0.5;
  scene_options.seed = 11;
  TargetScene scene = make_target_scene(scene_options);
  const std::vector<Bearing> bearings = bearings_until(scene, 2.3);
  const auto of_targets =
      std::count_if(bearings.begin(), bearings.end(), [](const Bearing& b) { return b.target >= 0; });
  const TrackStarts starts = start_tracks(bearings, {});
  ASSERT_EQ(starts.tracks.size(), 3U);
  EXPECT_EQ(starts.unclaimed.size(), bearings.size() - static_cast<std::size_t>(of_targets));
  for (const TargetTrack& track : starts.tracks) {
    EXPECT_TRUE(track.is_confirmed);
    EXPECT_EQ(track.sightings, 9);
    EXPECT_EQ(track.watches.size(), 3U);
  }
}

// Without motion noise the filter's answer is the batch's, covariance and all.
TEST(TrackStart, IsTheBatchFitForStraightFlight) {
  TargetSceneOptions scene_options;
  scene_options.targets = 1;
  scene_options.seed = 5;
  TargetScene scene = make_target_scene(scene_options);
  const std::vector<Bearing> bearings = bearings_until(scene, 4.3);
  const MotionAnswer answer = fit_motion(bearings);
  ASSERT_TRUE(answer.fit);
  TargetTrackerOptions options;
  options.filter.motion.acceleration_density = 0.0;
  const TargetState state = start_filter(answer.fit->state, bearings, options);
  const double sigma = std::sqrt(state.covariance.topLeftCorner<3, 3>().trace());
  EXPECT_LT((state.p_world - answer.fit->state.p_world).norm(), 0.02 * sigma);
  EXPECT_LT((state.covariance - answer.fit->state.covariance).norm(), 0.01 * state.covariance.norm());
}

// The bound, linearised at the truth, is what the filter thinks of itself, about.
TEST(KnownTarget, IsAsSureOfItselfAsTheBoundAllows) {
  TargetSceneOptions scene_options;
  scene_options.targets = 1;
  scene_options.periods = 12;
  scene_options.seed = 6;
  TargetScene scene = make_target_scene(scene_options);
  const std::vector<Bearing> bearings = bearings_until(scene, 12.0);
  const std::vector<Timestamp> times{at(0.5), at(4.2), at(11.2)};
  const auto states = follow_known_target(bearings, times);
  const auto bounds = tracking_bound(bearings, times, [&](Timestamp time) {
    TargetState truth;
    truth.time = time;
    truth.p_world = position_at(scene.paths[0], time);
    truth.v_world = velocity_at(scene.paths[0], time);
    return truth;
  });
  EXPECT_FALSE(states[0] || bounds[0]);  // two periods are needed to start
  for (const std::size_t i : {1U, 2U}) {
    ASSERT_TRUE(states[i] && bounds[i]);
    EXPECT_EQ(states[i]->time, times[i]);
    const double own = states[i]->covariance.topLeftCorner<3, 3>().trace();
    const double bound = bounds[i]->covariance.topLeftCorner<3, 3>().trace();
    EXPECT_NEAR(own / bound, 1.0, 0.05);
    EXPECT_LT((states[i]->p_world - bounds[i]->p_world).norm(), 5.0 * std::sqrt(own));
  }
}

}  // namespace
}  // namespace alidade
