// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/known_target.h"

#include <cmath>

#include <gtest/gtest.h>

#include "datasets/target_scene.h"

namespace alidade {
namespace {

Timestamp at(double seconds) {
  return Timestamp(from_seconds(seconds));
}

// The bound, linearised at the truth, is what the filter thinks of itself, about.
TEST(KnownTarget, IsAsSureOfItselfAsTheBoundAllows) {
  TargetSceneOptions scene_options;
  scene_options.targets = 1;
  scene_options.periods = 12;
  scene_options.seed = 6;
  const TargetScene scene = make_target_scene(scene_options);
  const std::vector<Bearing> bearings = bearings_of(scene.receivers, scene.readings);
  const std::vector<Timestamp> times{at(0.5), at(4.2), at(11.2)};
  const auto states = follow_known_target(bearings, times);
  const auto bounds = tracking_bound(bearings, times, [&](Timestamp time) {
    TargetState truth;
    truth.time = time;
    truth.p_world = position_at(scene.paths[0], time);
    truth.v_world = velocity_at(scene.paths[0], time);
    return truth;
  });
  EXPECT_FALSE(states[0] || bounds[0]);  // three looks are needed to start
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
