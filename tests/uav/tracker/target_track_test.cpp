// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/target_track.h"

#include <cmath>

#include <gtest/gtest.h>

namespace alidade {
namespace {

Bearing seen(int receiver, double time_s) {
  Bearing bearing;
  bearing.receiver = receiver;
  bearing.time = Timestamp(from_seconds(time_s));
  return bearing;
}

Timestamp at(double seconds) {
  return Timestamp(from_seconds(seconds));
}

TargetTrack followed(const TargetTrackerOptions& options) {
  TargetTrack track;
  for (int period = 0; period < 3; ++period) {
    for (int receiver = 0; receiver < 3; ++receiver) {
      note_sighting(track, seen(receiver, period + 0.1 * receiver), 5.0, options);
    }
  }
  return track;
}

TEST(TargetTrack, IsConfirmedByItsEvidence) {
  TargetTrackerOptions options;
  options.confirm_log_ratio = 12.0;
  TargetTrack track;
  note_sighting(track, seen(0, 0), 5.0, options);
  note_sighting(track, seen(1, 0), 5.0, options);
  EXPECT_FALSE(track.is_confirmed);
  note_sighting(track, seen(2, 0), 5.0, options);
  EXPECT_TRUE(track.is_confirmed);
  EXPECT_EQ(track.sightings, 3);
}

// However long it has lived, it lives on no longer than the greatest ratio lets it.
TEST(TargetTrack, LivesOnItsGreatestRatioAlone) {
  TargetTrackerOptions options;
  options.detection_probability = 0.95;
  TargetTrack track = followed(options);
  EXPECT_EQ(track.log_ratio, options.greatest_log_ratio);
  note_misses(track, at(3.4), options);
  EXPECT_EQ(track.log_ratio, options.greatest_log_ratio);
  note_misses(track, at(3.55), options);  // the first receiver's is due at 3.5, the next one's at 3.6
  EXPECT_NEAR(track.log_ratio, options.greatest_log_ratio + std::log(0.05), 1e-12);
  note_misses(track, at(4.65), options);
  EXPECT_NEAR(track.log_ratio, options.greatest_log_ratio + 5 * std::log(0.05), 1e-12);
  EXPECT_FALSE(is_gone(track, at(4.65), options));
  note_misses(track, at(4.75), options);
  EXPECT_TRUE(is_gone(track, at(4.75), options));
}

// What is counted does not depend on how often one asks.
TEST(TargetTrack, CountsEachMissOnce) {
  const TargetTrackerOptions options;
  TargetTrack once = followed(options), often = once;
  note_misses(once, at(5.0), options);
  for (int i = 20; i <= 50; ++i) note_misses(often, at(0.1 * i), options);
  EXPECT_NEAR(once.evidence, often.evidence, 1e-12);
}

// It has seen the target, and then looks elsewhere: the other two see it still.
TEST(TargetTrack, IsNotGivenUpBecauseOneReceiverLooksElsewhere) {
  TargetTrackerOptions options;
  options.detection_probability = 0.95;
  TargetTrack track = followed(options);
  for (int period = 3; period < 30; ++period) {
    for (int receiver = 0; receiver < 2; ++receiver) {
      const Bearing bearing = seen(receiver, period + 0.1 * receiver);
      note_misses(track, bearing.time, options);
      ASSERT_FALSE(is_gone(track, bearing.time, options)) << period;
      note_sighting(track, bearing, 5.0, options);
    }
  }
}

TEST(TargetTrack, IsGivenUpAfterItsPatienceAnyhow) {
  TargetTrackerOptions options;
  options.detection_probability = 0.1;
  TargetTrack track = followed(options);
  note_misses(track, at(7.19), options);
  EXPECT_FALSE(is_gone(track, at(7.19), options));
  EXPECT_TRUE(is_gone(track, at(7.21), options));
  EXPECT_TRUE(is_coasting(track, at(3.71), options));
  EXPECT_FALSE(is_coasting(track, at(3.69), options));
}

TEST(TemperatureReadings, AreAveragedWithTheirSpread) {
  TemperatureReadings readings;
  EXPECT_EQ(readings.spread_k(), 0.0);
  for (const double value : {300.0, 302.0, 304.0}) readings.add(value, 1.0);
  EXPECT_NEAR(readings.mean_k, 302.0, 1e-12);
  EXPECT_NEAR(readings.spread_k(), std::sqrt(8.0 / 3.0), 1e-12);
  readings.add(302.0, 0.0);
  EXPECT_EQ(readings.count, 3.0);
}

}  // namespace
}  // namespace alidade
