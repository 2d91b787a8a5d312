// SPDX-License-Identifier: Apache-2.0
#include "datasets/flight_recording.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/data_directory.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using test::TemporaryDirectory;

const std::string kReceivers =
    "pose_fit: {used_until_s: 2.0, flight_window_s: [1.0, 4.0]}\n"
    "receivers:\n"
    "  - {id: 0, name: a, width: 1920, height: 1080, fps: 10, camera_matrix: [1000, 0, 960, 0, 1100, 540, 0, 0, 1],\n"
    "     distortion: [0, 0, 0, 0], pose: {R: [0, 1, 0, 0, 0, -1, -1, 0, 0], t: [1, 2, 3]}, beta: 0.5, ppm: 100,\n"
    "     rolling_shutter: 0.03, fit: {median_px: 2}}\n"
    "  - {id: 3, name: b, width: 1920, height: 1080, fps: 30, camera_matrix: [1000, 0, 960, 0, 1000, 540, 0, 0, 1],\n"
    "     distortion: [0.1, 0, 0, 0, 0], pose: {R: [1, 0, 0, 0, 1, 0, 0, 0, 1], t: [0, 0, 0]}, beta: 0, ppm: 0,\n"
    "     rolling_shutter: 0, fit: {median_px: 1}}\n";
const std::string kObservations = "t,receiver,frame,u,v\n1.5001,0,10,100.5,200.25\n2.0,3,60,1,2\n";
const std::string kTruth = "t,x,y,z\n0.0,1,2,3\n0.2,4,5,6\n";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

std::string complaint(const std::string& receivers, const std::string& observations, const std::string& truth) {
  const TemporaryDirectory folder;
  folder.write("receivers.yaml", receivers);
  folder.write("observations.csv", observations);
  folder.write("groundtruth.csv", truth);
  return test::message_of(folder.path(), [&] { read_flight(folder.path()); });
}

TEST(FlightRecording, HasClocksAndPosesInOurTerms) {
  const TemporaryDirectory folder;
  folder.write("receivers.yaml", kReceivers);
  folder.write("observations.csv", kObservations);
  folder.write("groundtruth.csv", kTruth);
  const FlightRecording flight = read_flight(folder.path());

  ASSERT_EQ(flight.receivers.size(), 2u);
  const Receiver& a = flight.receivers[0];
  EXPECT_EQ(a.camera->fy, 1100.0);
  EXPECT_EQ(a.camera->readout_s, 0.03);
  EXPECT_NEAR(a.sigma, 2.0 / 1.17741, 1e-6);
  // x_cam = R x_world + t: the centre is -Rᵀ t.
  EXPECT_TRUE(a.T_world_receiver.translation().isApprox(Eigen::Vector3d(3, -1, 2), 1e-12));
  ASSERT_EQ(flight.readings.size(), 2u);
  // Frame 10 of 10 Hz is at 1 s of its own clock, 0.5 s + 100 ppm later by the common one.
  EXPECT_NEAR(to_seconds(flight.readings[0].time - Timestamp{}), 1.0, 1e-9);
  EXPECT_NEAR(to_seconds(common_time(a.clock, flight.readings[0].time) - Timestamp{}), 1.5001, 1e-9);
  EXPECT_EQ(flight.readings[0].value, Eigen::Vector2d(100.5, 200.25));
  EXPECT_EQ(flight.truth[1].p, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(flight.used_until, Timestamp(from_seconds(2.0)));
}

TEST(FlightRecording, SaysWhatIsWrongWithTheReceivers) {
  EXPECT_EQ(complaint(replaced(kReceivers, "R: [0, 1, 0, 0", "R: [0, 1, 0, 1"), kObservations, kTruth),
            "receivers.yaml:4: R is no rotation; x_cam = R x_world + t is wanted, R row by row");
  EXPECT_EQ(complaint(replaced(kReceivers, "id: 3", "id: 0"), kObservations, kTruth),
            "receivers.yaml:6: two receivers have the id 0");
  EXPECT_EQ(complaint(replaced(kReceivers, "beta: 0.5, ", ""), kObservations, kTruth),
            "receivers.yaml:3: the receiver has no 'beta'");
  EXPECT_EQ(complaint(replaced(kReceivers, "fps: 10", "fps: 0"), kObservations, kTruth),
            "receivers.yaml:3: fps must be > 0, got 0; correct the file");
  EXPECT_EQ(complaint(replaced(kReceivers, "used_until_s: 2.0", "used_until_s: 5.0"), kObservations, kTruth),
            "receivers.yaml:1: used_until_s must lie within flight_window_s");
}

TEST(FlightRecording, SaysWhatIsWrongWithTheTables) {
  EXPECT_EQ(complaint(kReceivers, replaced(kObservations, "2.0,3", "2.0,7"), kTruth),
            "observations.csv:3: receivers.yaml has no receiver 7");
  EXPECT_EQ(complaint(kReceivers, replaced(kObservations, "100.5", "nan"), kTruth),
            "observations.csv:2: column 'u': 'nan' is not a finite number; correct it or leave the row out");
  EXPECT_EQ(complaint(kReceivers, replaced(kObservations, "1.5001,0", "1.6001,0"), kTruth),
            "observations.csv:2: t is 0.1000 s from what frame 10 is by the clock of receiver 0");
  EXPECT_EQ(complaint(kReceivers, kObservations + "2.0,3,60,1,2\n", kTruth),
            "observations.csv:4: frame 60 of receiver 3 comes after frame 60");
  EXPECT_EQ(complaint(kReceivers, kObservations, replaced(kTruth, "0.2,4", "0.0,4")),
            "groundtruth.csv:3: time does not increase");
}

TEST(FlightRecording, ReadsTheRealFlight) {
  const auto folder = test::data_directory("uav");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const FlightRecording flight = read_flight(folder);
  EXPECT_EQ(flight.receivers.size(), 6u);
  EXPECT_EQ(flight.readings.size(), 82747u);
  EXPECT_EQ(flight.truth.size(), 3305u);
  // The centres stand in the file beside the poses.
  EXPECT_TRUE(
      flight.receivers[5].T_world_receiver.translation().isApprox(Eigen::Vector3d(31.6606, 74.3943, 1.0699), 1e-5));
}

}  // namespace
}  // namespace alidade
