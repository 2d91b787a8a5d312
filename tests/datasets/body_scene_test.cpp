// SPDX-License-Identifier: Apache-2.0
#include "datasets/body_scene.h"

#include <cmath>

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::vector<BodySceneFrame> all_frames(const BodySceneOptions& options) {
  BodyScene scene(options);
  std::vector<BodySceneFrame> frames;
  while (auto frame = scene.next()) frames.push_back(std::move(*frame));
  return frames;
}

const BodyMarker& marker_of(const BodyScene& scene, int id, int markers) {
  return scene.bodies()[static_cast<std::size_t>(id / markers)].markers[static_cast<std::size_t>(id % markers)];
}

TEST(BodyScene, ReadsEveryMarkerByEveryDetectorWhereNothingIsHidden) {
  for (const int markers : {3, 4, 8}) {
    BodySceneOptions options;
    options.frames = 20;
    options.markers = markers;
    const auto frames = all_frames(options);
    ASSERT_EQ(frames.size(), 20u);
    for (const auto& frame : frames) EXPECT_EQ(frame.readings.size(), static_cast<std::size_t>(12 * markers));
    EXPECT_EQ(frames[5].time, Timestamp(std::chrono::milliseconds(20)));
  }
}

TEST(BodyScene, ReadingsAreOfTheTrueMarkersWithTheNoiseAskedFor) {
  BodySceneOptions options;
  options.frames = 500;
  options.bodies = 2;
  options.skew_s = 0.003;
  BodyScene scene(options);
  double squares = 0;
  int count = 0;
  while (const auto frame = scene.next()) {
    for (const LineReading& r : frame->readings) {
      const Eigen::Vector3d p_world =
          pose_in_scene(r.marker / 4, r.time) * marker_of(scene, r.marker, options.markers).p_body;
      const auto projection = project(scene.detectors()[static_cast<std::size_t>(r.detector)], p_world);
      ASSERT_TRUE(projection);
      squares += std::pow((r.value - projection->value) / options.sigma_rad, 2);
      ++count;
    }
  }
  EXPECT_EQ(count, 500 * 2 * 48);
  EXPECT_NEAR(squares / count, 1.0, 5 * std::sqrt(2.0 / count));
}

TEST(BodyScene, BlocksStandRoundTheCentreAndLookAtIt) {
  const BodyScene scene({});
  ASSERT_EQ(scene.detectors().size(), 12u);
  for (const LineDetector& detector : scene.detectors()) {
    const Eigen::Vector3d centre = detector.T_world_station.translation();
    EXPECT_NEAR(centre.head<2>().norm(), 3.0, 1e-12);
    const Eigen::Vector3d target = detector.T_world_station.inverse() * Eigen::Vector3d(0, 0, 1);
    EXPECT_LT(target.head<2>().norm(), 1e-12);
    EXPECT_GT(target.z(), 2.9);
    // The focal line lies in the plane across the block's view.
    EXPECT_NEAR(detector.T_station_detector.linear().col(1).z(), 0.0, 1e-12);
  }
  const auto y = [&scene](std::size_t i) { return scene.detectors()[i].T_station_detector.linear().col(1); };
  EXPECT_NEAR(y(0).dot(y(1)), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(y(0).dot(y(2)), 0.0, 1e-12);
  EXPECT_NEAR((centre_world(scene.detectors()[0]) - centre_world(scene.detectors()[1])).norm(), 0.15, 1e-12);
  EXPECT_EQ(scene.detectors()[4].station, "block2");
}

TEST(BodyScene, TwistIsTheDerivativeOfThePose) {
  for (int ms = -700; ms < 5000; ms += 190) {
    const Timestamp time{std::chrono::milliseconds(ms)};
    const auto h = std::chrono::microseconds(10);
    const Vector6d expected = difference(pose_in_scene(1, time - h), pose_in_scene(1, time + h)) / 2e-5;
    const Eigen::Matrix3d half_back = pose_in_scene(1, time).linear().transpose() * pose_in_scene(1, time - h).linear();
    Vector6d along_axes = expected;
    along_axes.head<3>() = half_back * expected.head<3>();
    EXPECT_LT((twist_in_scene(1, time) - along_axes).norm(), 1e-6) << ms;
  }
}

TEST(BodyScene, WrongIdsAreOtherMarkersOfTheSameBody) {
  BodySceneOptions options;
  options.frames = 400;
  options.bodies = 2;
  options.wrong_ids = 0.3;
  BodyScene scene(options);
  int wrong = 0, count = 0;
  while (const auto frame = scene.next()) {
    for (std::size_t i = 0; i < frame->readings.size(); ++i) {
      const LineReading& r = frame->readings[i];
      const auto& detector = scene.detectors()[static_cast<std::size_t>(r.detector)];
      const Eigen::Isometry3d T = pose_in_scene(r.marker / 4, frame->time);
      const double off = r.value - project(detector, T * marker_of(scene, r.marker, 4).p_body)->value;
      EXPECT_TRUE(!frame->is_right[i] || std::abs(off) < 6e-4) << off;
      wrong += frame->is_right[i] ? 0 : 1;
      ++count;
    }
  }
  EXPECT_NEAR(wrong / static_cast<double>(count), 0.3, 0.01);
}

TEST(BodyScene, RightReadingsAreThoseFlaggedSo) {
  BodySceneFrame frame;
  frame.readings = {{{}, 0, 1, 0.1, 0}, {{}, 0, 2, 0.2, 0}, {{}, 0, 3, 0.3, 0}};
  frame.is_right = {true, false, true};
  const auto right = right_readings(frame);
  ASSERT_EQ(right.size(), 2u);
  EXPECT_EQ(right[1].marker, 3);
}

TEST(BodyScene, HidesAMarkerFromAllOfABlockInBursts) {
  BodySceneOptions options;
  options.frames = 20000;
  options.occluded = 0.6;
  BodyScene scene(options);
  int seen = 0, changes = 0;
  bool was_seen = false;
  while (const auto frame = scene.next()) {
    int of_first_block = 0;
    for (const LineReading& r : frame->readings) of_first_block += r.marker == 0 && r.detector < 4 ? 1 : 0;
    EXPECT_TRUE(of_first_block == 0 || of_first_block == 4);
    changes += (of_first_block > 0) != was_seen ? 1 : 0;
    was_seen = of_first_block > 0;
    seen += static_cast<int>(frame->readings.size());
  }
  EXPECT_NEAR(seen / (20000.0 * 48), 0.4, 0.03);
  EXPECT_NEAR(changes / 20000.0, 0.03 * 2 * 0.6 * 0.4, 0.003);
}

TEST(BodyScene, SkewedReadingsAreInOrderOfTimeWithinTheirFrame) {
  BodySceneOptions options;
  options.frames = 3;
  options.skew_s = 0.004;
  for (const auto& frame : all_frames(options)) {
    for (std::size_t i = 1; i < frame.readings.size(); ++i) {
      EXPECT_LT(frame.readings[i - 1].time, frame.readings[i].time);
    }
    EXPECT_GE(frame.readings.front().time, frame.time);
    EXPECT_GT(frame.readings.back().time, frame.time + std::chrono::microseconds(3800));
    EXPECT_LT(frame.readings.back().time, frame.time + std::chrono::milliseconds(4));
  }
}

TEST(BodyScene, IsTheSameForTheSameSeedAlone) {
  BodySceneOptions options;
  options.frames = 5;
  options.wrong_ids = 0.2;
  const auto values = [&options] {
    std::vector<double> all;
    for (const auto& frame : all_frames(options)) {
      for (const LineReading& r : frame.readings) all.push_back(r.value + r.marker);
    }
    return all;
  };
  const auto first = values();
  EXPECT_EQ(first, values());
  options.seed = 2;
  EXPECT_NE(first, values());
}

TEST(BodyScene, NoiseIsTheSameWithOcclusion) {
  BodySceneOptions options;
  options.frames = 50;
  const auto clean = all_frames(options);
  options.occluded = 0.6;
  const auto occluded = all_frames(options);
  for (std::size_t f = 0; f < clean.size(); ++f) {
    std::size_t i = 0;
    for (const LineReading& r : occluded[f].readings) {
      while (clean[f].readings[i].detector != r.detector || clean[f].readings[i].marker != r.marker) ++i;
      EXPECT_EQ(clean[f].readings[i].value, r.value);
    }
  }
}

TEST(BodySceneOptions, AreRefusedByName) {
  BodySceneOptions options;
  options.markers = 5;
  try {
    validate(options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "markers must be 3, 4 or 8, got 5");
  }
  options = {};
  options.skew_s = 0.005;
  EXPECT_THROW(BodyScene{options}, std::invalid_argument);
  options = {};
  options.occluded = std::nan("");
  EXPECT_THROW(BodyScene{options}, std::invalid_argument);
}

}  // namespace
}  // namespace alidade
