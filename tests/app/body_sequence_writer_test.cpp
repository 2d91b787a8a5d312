// SPDX-License-Identifier: Apache-2.0
#include "app/body_sequence_writer.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/body_file.h"
#include "io/detector_file.h"
#include "io/trajectory_file.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

BodySceneOptions small_scene() {
  BodySceneOptions options;
  options.frames = 5;
  options.bodies = 2;
  options.skew_s = 0.004;
  return options;
}

TEST(BodySequenceWriter, WritesWhatIsReadBack) {
  const test::TemporaryDirectory temporary;
  const auto out = temporary.path() / "body";
  BodyScene scene(small_scene());
  std::vector<LineReading> readings;
  {
    ResultDirectory directory(out, "simulate body");
    BodySequenceWriter writer(directory, scene.detectors(), scene.bodies());
    while (const auto frame = scene.next()) {
      writer.add(*frame, {pose_in_scene(0, frame->time), pose_in_scene(1, frame->time)});
      readings.insert(readings.end(), frame->readings.begin(), frame->readings.end());
    }
    writer.finish();
    directory.commit(nlohmann::json::object());
  }
  const auto bodies = read_bodies(out / "body.csv");
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_EQ(bodies[1].markers[3].p_body, scene.bodies()[1].markers[3].p_body);
  const DetectorRig rig = read_detector_rig(out / "detectors.yaml");
  ASSERT_EQ(rig.detectors.size(), 12u);
  EXPECT_EQ(rig.detectors[7].sigma, 1e-4);
  ReadingReader reader(out / "observations.csv", rig.detectors, bodies);
  for (const LineReading& expected : readings) {
    const auto reading = reader.next();
    ASSERT_TRUE(reading);
    EXPECT_EQ(reading->time, expected.time);
    EXPECT_EQ(reading->detector, expected.detector);
    EXPECT_EQ(reading->marker, expected.marker);
    EXPECT_EQ(reading->value, expected.value);
  }
  EXPECT_FALSE(reader.next());
  const Trajectory truth = read_trajectory(out / "truth_body2.tum").poses;
  ASSERT_EQ(truth.size(), 5u);
  EXPECT_LT(difference(truth[4].T_world_camera, pose_in_scene(1, truth[4].time)).norm(), 1e-12);
}

TEST(BodySequenceWriter, ASingleBodysTruthHasThePlainName) {
  BodySceneOptions options = small_scene();
  EXPECT_EQ(truth_file(BodyScene(options).bodies(), 0), "truth_body1.tum");
  options.bodies = 1;
  EXPECT_EQ(truth_file(BodyScene(options).bodies(), 0), "truth.tum");
}

}  // namespace
}  // namespace alidade
