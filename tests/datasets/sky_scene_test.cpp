// SPDX-License-Identifier: Apache-2.0
#include "datasets/sky_scene.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(SkyScene, KeepsEveryTargetInTheViewOfEveryCameraAndMoving) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SkySceneOptions options;
    options.seed = seed;
    const SkyScene scene = make_sky_scene(options);
    ASSERT_EQ(scene.paths.size(), options.dots.size());
    for (const TargetPath& path : scene.paths) {
      for (double t = 0.0; t <= options.duration_s; t += 0.5) {
        const Timestamp time(from_seconds(t)), soon = time + from_seconds(0.1);
        EXPECT_GT(position_at(path, time).z(), 0.0);
        for (const Receiver& receiver : scene.receivers) {
          const auto here = reading_of(receiver, position_at(path, time), time);
          const auto there = reading_of(receiver, position_at(path, soon), soon);
          ASSERT_TRUE(here) << "seed " << seed;
          if (!there) continue;
          EXPECT_GT((there->value - here->value).norm(), 0.2) << "seed " << seed;
        }
      }
    }
  }
}

TEST(SkyScene, CamerasHaveClocksAndRatesOfTheirOwn) {
  const SkyScene scene = make_sky_scene();
  ASSERT_EQ(scene.receivers.size(), 3U);
  EXPECT_NE(scene.fps_hz[0], scene.fps_hz[1]);
  EXPECT_NE(scene.receivers[1].clock.offset_s, scene.receivers[2].clock.offset_s);
  for (const Receiver& receiver : scene.receivers) EXPECT_FALSE(find_fault(receiver)) << *find_fault(receiver);
}

TEST(SkyScene, NamesWhatIsImpossible) {
  SkySceneOptions options;
  options.dots[0].size_px = 0.0;
  EXPECT_THROW(make_sky_scene(options), std::invalid_argument);
  options = {};
  options.range_m = 10.0;
  EXPECT_THROW(make_sky_scene(options), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
