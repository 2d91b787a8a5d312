// SPDX-License-Identifier: Apache-2.0
#include "datasets/scan_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Eigen::Vector3d;

TargetSceneOptions scene_with(ScanLaw law) {
  TargetSceneOptions options;
  options.targets = 4;
  options.scan_law = law;
  return options;
}

Vector3d sight(const Receiver& receiver, const TargetPath& path, Timestamp time) {
  return (position_at(path, time) - receiver.T_world_receiver.translation()).normalized();
}

TEST(ScanTimes, OfDelaysAreThoseOfTheReceiver) {
  const TargetSceneOptions options = scene_with(ScanLaw::Delays);
  const TargetScene scene = make_target_scene(options);
  const Timestamp begin(std::chrono::seconds(3));
  for (const Receiver& receiver : scene.receivers) {
    for (const auto& time : scan_times(options, receiver, scene.paths, begin)) {
      EXPECT_EQ(time, begin + std::chrono::milliseconds(100 * receiver.id));
    }
  }
  EXPECT_EQ(scan_ends(options, begin)[2], begin + std::chrono::milliseconds(200));
}

// The beam of receiver k stands at azimuth 0 at its delay, and turns by 2 π in a period.
TEST(ScanTimes, OfARotatingBeamAreWhenItPassesTheTarget) {
  const TargetSceneOptions options = scene_with(ScanLaw::Rotating);
  const TargetScene scene = make_target_scene(options);
  const Timestamp begin(std::chrono::seconds(1));
  int met = 0;
  for (const Receiver& receiver : scene.receivers) {
    const auto times = scan_times(options, receiver, scene.paths, begin);
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (!times[i]) continue;
      ++met;
      EXPECT_GE(*times[i], begin);
      EXPECT_LT(*times[i], begin + std::chrono::seconds(1));
      const Vector3d d = sight(receiver, scene.paths[i], *times[i]);
      const double beam = 2.0 * std::numbers::pi * (to_seconds(*times[i] - begin) - 0.1 * receiver.id);
      EXPECT_NEAR(std::sin(std::atan2(d.y(), d.x()) - beam), 0.0, 1e-5);
      EXPECT_GT(std::cos(std::atan2(d.y(), d.x()) - beam), 0.0);
    }
  }
  EXPECT_GE(met, 10);
}

TEST(ScanTimes, OfACuedReceiverFollowOneAnotherByTheAngleBetween) {
  TargetSceneOptions options = scene_with(ScanLaw::Cued);
  const TargetScene scene = make_target_scene(options);
  const Timestamp begin(std::chrono::seconds(2));
  for (const auto& time : scan_times(options, scene.receivers[0], scene.paths, begin)) EXPECT_EQ(time, begin);
  const Receiver& receiver = scene.receivers[1];
  const auto times = scan_times(options, receiver, scene.paths, begin);
  std::vector<std::size_t> order{0, 1, 2, 3};
  for (const auto& time : times) ASSERT_TRUE(time);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return *times[a] < *times[b]; });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Timestamp from = *times[order[i - 1]];
    const Vector3d beam = sight(receiver, scene.paths[order[i - 1]], from);
    const double angle = std::acos(std::clamp(beam.dot(sight(receiver, scene.paths[order[i]], from)), -1.0, 1.0));
    EXPECT_NEAR(to_seconds(*times[order[i]] - from), angle / options.slew_rad_s, 1e-6);
  }
  options.slew_rad_s = 0.05;  // too slow to come to all
  const auto slow = scan_times(options, receiver, scene.paths, begin);
  EXPECT_TRUE(std::any_of(slow.begin(), slow.end(), [](const auto& time) { return !time; }));
  EXPECT_EQ(scan_ends(options, begin)[1], begin + std::chrono::seconds(1));
}

}  // namespace
}  // namespace alidade
