// SPDX-License-Identifier: Apache-2.0
#include "app/live_messages.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

using Json = nlohmann::ordered_json;

FrameReport tracked_frame() {
  FrameReport report;
  report.index = 7;
  report.time = Timestamp(std::chrono::milliseconds(250));
  report.state = FrameState::Tracked;
  report.T_world_camera.translation() = Eigen::Vector3d(1, 2, 3);
  report.covariance = Matrix6d::Identity();
  report.covariance(0, 5) = 0.5;
  return report;
}

BodyEstimate tracked_body() {
  BodyEstimate estimate;
  estimate.time = Timestamp(std::chrono::milliseconds(4));
  estimate.status = BodyStatus::Tracked;
  estimate.state.T_world_body = Eigen::Translation3d(0.25, 0, 0) * Eigen::AngleAxisd(4.0, Eigen::Vector3d::UnitZ());
  estimate.state.v_world = Eigen::Vector3d(0, 1, 0);
  return estimate;
}

TEST(HelloMessage, NamesSchemaClockAndFrames) {
  const Json hello = hello_message({"track body", "readings.csv", "of the readings", "T_world_body", true, {"a", "b"}});
  EXPECT_EQ(hello.dump().substr(0, 59), R"({"type":"hello","schema":"alidade.live","version":1,"progra)");
  EXPECT_EQ(hello["clock"], "of the readings");
  EXPECT_EQ(hello["pose"], "T_world_body");
  EXPECT_EQ(hello["unit_of_length"], "m");
  EXPECT_EQ(hello["bodies"], (Json{"a", "b"}));
  const Json camera = hello_message({"track camera", "v.mp4", "of the recording", "T_world_camera", false});
  EXPECT_EQ(camera["unit_of_length"], "free");
  EXPECT_FALSE(camera.contains("bodies"));
}

TEST(CameraMessage, TellsPoseCovarianceAndWhatWasLostBefore) {
  CaptureStamp stamp;
  stamp.sequence = 99;
  stamp.discarded_before = 2;
  const Json message = pose_message("cam", tracked_frame(), stamp);
  EXPECT_EQ(message["frame"], 7);
  EXPECT_EQ(message["t_ns"], 250'000'000);
  EXPECT_EQ(message["state"], "tracked");
  EXPECT_FALSE(message.contains("reason"));
  EXPECT_EQ(message["T_world_camera"]["p_m"], (Json{1.0, 2.0, 3.0}));
  EXPECT_EQ(message["T_world_camera"]["q_wxyz"], (Json{1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(message["covariance"][0], (Json{1.0, 0.0, 0.0, 0.0, 0.0, 0.5}));
  EXPECT_EQ(message["covariance"][5], (Json{0.0, 0.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(message["sequence"], 99);
  EXPECT_EQ(message["dropped_before"], 0);
  EXPECT_EQ(message["discarded_before"], 2);
}

TEST(CameraMessage, TellsWhyThereIsNoPose) {
  FrameReport report;
  report.reason = "the scene is dark";
  EXPECT_EQ(pose_message("cam", report, {}).dump(),
            R"({"type":"pose","source":"cam","frame":0,"t_ns":0,"state":"waiting","reason":"the scene is dark",)"
            R"("dropped_before":0,"discarded_before":0})");
}

TEST(BodyMessage, TellsPoseAndMotion) {
  const Json message = pose_message("-", "probe", tracked_body(), PoseDetail::Motion);
  EXPECT_EQ(message["body"], "probe");
  EXPECT_EQ(message["t_ns"], 4'000'000);
  EXPECT_EQ(message["T_world_body"]["p_m"][0], 0.25);
  EXPECT_GE(message["T_world_body"]["q_wxyz"][0], 0.0);
  EXPECT_EQ(message["covariance"].size(), 6u);
  EXPECT_EQ(message["v_world_m_s"], (Json{0.0, 1.0, 0.0}));
  EXPECT_EQ(message["omega_body_rad_s"].size(), 3u);
}

TEST(BodyMessage, LeavesOutWhatIsNotKnown) {
  EXPECT_FALSE(pose_message("-", "probe", tracked_body(), PoseDetail::Pose).contains("covariance"));
  BodyEstimate lost = tracked_body();
  lost.status = BodyStatus::Lost;
  EXPECT_EQ(pose_message("-", "probe", lost, PoseDetail::Motion).dump(),
            R"({"type":"pose","source":"-","body":"probe","t_ns":4000000,"state":"lost"})");
}

TEST(TargetMessage, TellsPlaceMotionAndCovarianceInTheWorld) {
  TargetRow row;
  row.time = Timestamp(std::chrono::milliseconds(250));
  row.target = 3;
  row.state = "coasting";
  row.p_world = Eigen::Vector3d(1, 2, 3);
  row.v_world = Eigen::Vector3d(0, -4, 0);
  row.sightings = 11;
  EXPECT_EQ(target_message("sim", row).dump(),
            R"({"type":"target","source":"sim","target":3,"t_ns":250000000,"state":"coasting",)"
            R"("p_world_m":[1.0,2.0,3.0],"v_world_m_s":[0.0,-4.0,0.0],"sightings":11})");
  row.covariance = Matrix6d::Identity();
  (*row.covariance)(0, 5) = 0.5;
  row.temperature_k = 300.0;
  row.temperature_sigma_k = 2.5;
  const Json message = target_message("sim", row);
  EXPECT_EQ(message["covariance"].size(), 6u);
  EXPECT_EQ(message["covariance"][0], (Json{1.0, 0.0, 0.0, 0.0, 0.0, 0.5}));
  EXPECT_EQ(message["temperature_k"], 300.0);
  EXPECT_EQ(message["temperature_sigma_k"], 2.5);
}

TEST(CueMessage, TellsWhomToLookWhereAndWhen) {
  AddressedCue cue;
  cue.told = Timestamp(std::chrono::seconds(1));
  cue.target = 3;
  cue.receiver = 2;
  cue.cue.time = Timestamp(std::chrono::milliseconds(1500));
  cue.cue.own_time = Timestamp(std::chrono::milliseconds(1250));
  cue.cue.azimuth_elevation = Eigen::Vector2d(0.25, -0.5);
  cue.cue.covariance << 1.0, 0.5, 0.5, 2.0;
  cue.cue.range_m = 150.0;
  EXPECT_EQ(cue_message(cue).dump(),
            R"({"type":"cue","target":3,"receiver":2,"told_ns":1000000000,"t_ns":1500000000,"own_t_ns":1250000000,)"
            R"("azimuth_rad":0.25,"elevation_rad":-0.5,"covariance":[[1.0,0.5],[0.5,2.0]],"range_m":150.0})");
}

TEST(EndMessage, SaysHowItEnded) {
  EXPECT_EQ(end_message({10, 8, true}).dump(), R"({"type":"end","frames":10,"tracked":8,"interrupted":true})");
}

}  // namespace
}  // namespace alidade
