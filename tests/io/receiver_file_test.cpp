// SPDX-License-Identifier: Apache-2.0
#include "io/receiver_file.h"

#include <chrono>

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "io/rig_file.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using test::message_of;

class ReceiverFile : public ::testing::Test {
 protected:
  test::TemporaryDirectory folder_;

  std::string refusal(const std::string& yaml) const {
    const auto path = folder_.write("receivers.yaml", yaml);
    return message_of(folder_.path(), [&] { read_receivers(path); });
  }
};

std::vector<Receiver> made() {
  Receiver finder;
  finder.id = 4;
  finder.name = "north \"mast\"";
  finder.sigma = 0.002;
  finder.axes = FinderAxes::YUp;
  finder.T_world_receiver.linear() = exp_so3({0.3, -2.0, 0.8});
  finder.T_world_receiver.translation() = Eigen::Vector3d(100.25, -3, 1.5);
  finder.pose_covariance = 1e-4 * Matrix6d::Identity();
  finder.clock = {0.25, -3e-5, Timestamp(std::chrono::seconds(300)), Eigen::Vector2d(1e-6, 1e-12).asDiagonal()};
  Receiver camera;
  camera.id = 2;
  camera.name = "south";
  camera.camera = Camera{1920, 1080, 1500, 1490, 960, 540, BrownConrady{0.1, -0.2, 0, 0, 0.05}, 0.02};
  camera.sigma = 0.5;
  camera.T_world_receiver.translation() = Eigen::Vector3d(0, 60, 2);
  return {finder, camera};
}

TEST_F(ReceiverFile, GivesBackWhatWasWritten) {
  const std::vector<Receiver> written = made();
  write_receivers(folder_ / "receivers.yaml", written);
  const std::vector<Receiver> read = read_receivers(folder_ / "receivers.yaml");
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].id, written[i].id);
    EXPECT_EQ(read[i].name, written[i].name);
    EXPECT_EQ(read[i].camera, written[i].camera);
    EXPECT_EQ(read[i].axes, written[i].axes);
    EXPECT_EQ(read[i].sigma, written[i].sigma);
    EXPECT_TRUE(read[i].T_world_receiver.isApprox(written[i].T_world_receiver, 1e-14));
    EXPECT_EQ(read[i].pose_covariance, written[i].pose_covariance);
    EXPECT_EQ(read[i].clock.offset_s, written[i].clock.offset_s);
    EXPECT_EQ(read[i].clock.rate, written[i].clock.rate);
    EXPECT_EQ(read[i].clock.reference, written[i].clock.reference);
    EXPECT_EQ(read[i].clock.covariance, written[i].clock.covariance);
  }
}

TEST_F(ReceiverFile, TakesARigOfCamerasAsReceivers) {
  RigCamera left{"left", Camera{640, 480, 500, 500, 320, 240, {}}};
  RigCamera right = left;
  right.name = "right";
  right.T_rig_camera.translation().x() = 30;
  right.clock_offset_s = 0.125;
  write_camera_rig(folder_ / "rig.yaml", {{left, right}});
  const std::vector<Receiver> read = read_receivers(folder_ / "rig.yaml");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[1].id, 1);
  EXPECT_EQ(read[1].name, "right");
  EXPECT_EQ(read[1].camera, right.camera);
  EXPECT_DOUBLE_EQ(read[1].T_world_receiver.translation().x(), 30);
  EXPECT_DOUBLE_EQ(read[1].clock.offset_s, 0.125);
}

const std::string kPose = "T_world_receiver: {translation_m: [0, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}";

TEST_F(ReceiverFile, WantsAClockOfEachReceiver) {
  EXPECT_EQ(
      refusal("receivers:\n  - {id: 0, name: mast, model: direction_finder, sigma_rad: 0.1, " + kPose + "}\n"),
      "receivers.yaml:2: receiver 'mast' has no clock; write 'clock: {offset_s: ...}', or 'clock: common' where it "
      "runs with the others'");
}

TEST_F(ReceiverFile, NamesTheLineThatIsWrong) {
  const std::string head = "receivers:\n  - {id: 0, model: direction_finder, clock: common, " + kPose + ", ";
  EXPECT_EQ(
      refusal(head + "sigma_rad: 1.5}\n"),
      "receivers.yaml:2: receiver 'receiver 0': sigma of a direction finder must be <= 0.5 rad, got 1.5: are these "
      "degrees?; correct the file");
  EXPECT_EQ(refusal(head + "sigma_px: 1}\n"), "receivers.yaml:2: a direction finder reads angles; write sigma_rad");
  EXPECT_EQ(refusal(head + "sigma_rad: .nan}\n"), "receivers.yaml:2: '.nan' is not a number");
  EXPECT_EQ(refusal(head + "sigma_rad: 0.1, axis: y_up}\n"),
            "receivers.yaml:2: unknown key 'axis'; did you mean 'axes'?");
  const std::string one = "  - {id: 7, model: direction_finder, clock: common, sigma_rad: 0.1, " + kPose + "}\n";
  EXPECT_EQ(refusal("receivers:\n" + one + one), "receivers.yaml:3: two receivers have the id 7; give each its own");
  EXPECT_EQ(refusal("receivers: []\n"), "receivers.yaml:1: a list of receivers is wanted");
}

}  // namespace
}  // namespace alidade
