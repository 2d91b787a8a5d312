// SPDX-License-Identifier: Apache-2.0
#include "io/rig_file.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

Eigen::MatrixXd covariance_of(const Camera& camera, Eigen::Index free) {
  const Eigen::Index count = intrinsics(camera).size();
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(count, count);
  C.topLeftCorner(free, free).setConstant(1.0 / 300);
  for (Eigen::Index i = 0; i < free; ++i) C(i, i) = 0.1 * static_cast<double>(i + 1);
  return C;
}

CameraRig make_rig() {
  RigCamera left{"left", {640, 480, 500.1, 501, 320, 1.0 / 3, BrownConrady{-0.1, 0.2}}};
  left.intrinsics_covariance = covariance_of(left.camera, 6);
  RigCamera right{"right", {1280, 800, 400, 401, 639.5, 399.5, Fisheye{0.1, 0.01, 0, 1e-5}, 0.02}};
  right.T_rig_camera = perturbation((Vector6d() << 0.12, -0.01, 1.0 / 3, 0.3, -2, 0.1).finished());
  right.intrinsics_covariance = covariance_of(right.camera, 8);
  right.pose_covariance = Matrix6d::Identity() / 3e6 + 1e-7 * Matrix6d::Ones();
  right.clock_offset_s = -0.0123456789;
  return {{left, right}};
}

void expect_same(const RigCamera& a, const RigCamera& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.camera, b.camera);
  EXPECT_EQ(a.intrinsics_covariance, b.intrinsics_covariance);
  EXPECT_EQ(a.pose_covariance, b.pose_covariance);
  EXPECT_EQ(a.clock_offset_s, b.clock_offset_s);
  EXPECT_EQ(a.T_rig_camera.translation(), b.T_rig_camera.translation());
  EXPECT_TRUE(a.T_rig_camera.isApprox(b.T_rig_camera, 1e-15));
}

class RigFile : public testing::Test {
 protected:
  // Of a file with one camera and the lines `rest` from line 6.
  std::string message(const std::string& rest) {
    const std::string head =
        "camera:\n  name: left\n  model: fisheye\n  resolution_px: [640, 480]\n"
        "  intrinsics_px: {fx: 500, fy: 500, cx: 320, cy: 240}\n";
    return test::message_of(folder_.path(), [&] { read_camera_rig(folder_.write("rig.yaml", head + rest)); });
  }
  test::TemporaryDirectory folder_;
};

TEST_F(RigFile, GivesBackExactlyWhatWasWritten) {
  const CameraRig rig = make_rig();
  write_camera_rig(folder_ / "rig.yaml", rig);
  const CameraRig back = read_camera_rig(folder_ / "rig.yaml");
  ASSERT_EQ(back.cameras.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) expect_same(back.cameras[i], rig.cameras[i]);
}

TEST_F(RigFile, OfOneCameraIsACameraFile) {
  for (const RigCamera& camera : make_rig().cameras) {
    write_camera_rig(folder_ / "camera.yaml", {{camera}});
    EXPECT_EQ(read_camera(folder_ / "camera.yaml"), camera.camera);
    expect_same(read_camera_rig(folder_ / "camera.yaml").cameras.at(0), camera);
  }
}

TEST_F(RigFile, KnowsNothingOfWhatIsLeftOut) {
  write_camera(folder_ / "camera.yaml", make_rig().cameras[0].camera, "alone");
  expect_same(read_camera_rig(folder_ / "camera.yaml").cameras.at(0), {"alone", make_rig().cameras[0].camera});
}

TEST_F(RigFile, NamesWhatIsWrong) {
  EXPECT_EQ(message("  T_rig_camera: [1, 2, 3]\n"),
            "rig.yaml:6: names with values are wanted here; e.g. {translation_m: [0, 0, 0], quaternion_wxyz: [1, 0, 0, "
            "0]}");
  EXPECT_EQ(message("  pose_covariance: [1, 2]\n"),
            "rig.yaml:6: a list of 21 numbers is wanted here; e.g. the upper triangle of the 6x6 matrix, row by row");
  EXPECT_EQ(message("  intrinsics_covariance:\n    parameters: [fx, k5]\n    covariance: [1, 0, 1]\n"),
            "rig.yaml:7: unknown parameter 'k5'; did you mean 'k1'?");
  EXPECT_EQ(message("  intrinsics_covariance:\n    parameters: [fx, fx]\n    covariance: [1, 0, 1]\n"),
            "rig.yaml:7: 'fx' is listed twice");
  EXPECT_EQ(message("  intrinsics_covariance:\n    parameters: [fx, k1]\n    covariance: [1, 1, 0.5]\n"),
            "rig.yaml:8: the covariance is not positive semi-definite; calibrate again, or leave it out");
  EXPECT_EQ(message("  intrinsics_covariance:\n    parameters: []\n    covariance: []\n"),
            "rig.yaml:7: a list of names is wanted here; e.g. [fx, fy, cx, cy]");
  EXPECT_EQ(message("  clock_offset_s: late\n"), "rig.yaml:6: 'late' is not a number");
  EXPECT_EQ(message("  clock_offset: 1\n"), "rig.yaml:6: unknown key 'clock_offset'; did you mean 'clock_offset_s'?");
  const std::string camera =
      "  - {name: a, model: pinhole, resolution_px: [640, 480], intrinsics_px: {fx: 5, fy: 5, cx: 3, cy: 3}}\n";
  EXPECT_EQ(test::message_of(folder_.path(),
                             [&] { read_camera_rig(folder_.write("rig.yaml", "cameras:\n" + camera + camera)); }),
            "rig.yaml:3: two cameras are named 'a'; rename one");
}

TEST_F(RigFile, IsNotWrittenWhereItCouldNotBeRead) {
  CameraRig twice = make_rig();
  twice.cameras[1].name = "left";
  EXPECT_THROW(format_camera_rig(twice), std::invalid_argument);
  EXPECT_THROW(format_camera_rig({}), std::invalid_argument);
  CameraRig other_model = make_rig();
  other_model.cameras[0].intrinsics_covariance = Eigen::MatrixXd::Identity(4, 4);
  EXPECT_THROW(format_camera_rig(other_model), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
