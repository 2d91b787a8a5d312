// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/track_start.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "datasets/target_scene.h"
#include "uav/batch/motion_fit.h"

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

// So many bearings by so many receivers in turn, evenly in time.
std::vector<Bearing> seen(int count, int receivers, double last_s) {
  std::vector<Bearing> bearings(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    bearings[static_cast<std::size_t>(i)].receiver = i % receivers;
    bearings[static_cast<std::size_t>(i)].time = at(last_s * i / (count - 1));
  }
  return bearings;
}

TEST(TrackStart, NeedsSightingsOfThreeLooks) {
  EXPECT_TRUE(has_sightings_to_start(seen(8, 3, 2.1), {}));
  EXPECT_FALSE(has_sightings_to_start(seen(7, 3, 2.1), {}));
  EXPECT_FALSE(has_sightings_to_start(seen(12, 3, 1.2), {}));
  EXPECT_TRUE(has_sightings_to_start(seen(6, 3, 3.1), {}));
  EXPECT_FALSE(has_sightings_to_start(seen(5, 3, 3.1), {}));
  EXPECT_FALSE(has_sightings_to_start({}, {}));
}

// Of six receivers that could have seen it 18 times.
TEST(TrackStart, NeedsFourFifthsOfWhatItsReceiversCouldHaveSeen) {
  EXPECT_TRUE(has_sightings_to_start(seen(15, 6, 2.2), {}));
  EXPECT_FALSE(has_sightings_to_start(seen(14, 6, 2.2), {}));
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

}  // namespace
}  // namespace alidade
