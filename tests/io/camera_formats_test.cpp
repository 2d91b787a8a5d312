// SPDX-License-Identifier: Apache-2.0
#include "io/camera_formats.h"

#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "io/rig_file.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

constexpr CameraFormat kFormats[] = {CameraFormat::Alidade, CameraFormat::OpenCv, CameraFormat::Ros,
                                     CameraFormat::Kalibr,  CameraFormat::Colmap, CameraFormat::Mrcal};

const BrownConrady kRadtan{-0.28, 0.07, 0.0002, -1.0 / 3000};
const BrownConrady kFive{-0.28, 0.07, 0.0002, -1.0 / 3000, 0.01};
const BrownConrady kRational{0.3, -0.1, 0.0002, -1.0 / 3000, 0.001, 0.6, -0.01, 0.002};
const Fisheye kFisheye{-0.01, 0.02, -1.0 / 300, 0.001};
const Distortion kLenses[] = {BrownConrady{}, kRadtan, kFive, kRational, kFisheye};

Camera camera_with(const Distortion& distortion) {
  return {640, 480, 458.654, 457.296, 1100.0 / 3, 248.375, distortion};
}

CameraRig rig_of(const Distortion& distortion, std::size_t cameras = 1) {
  CameraRig rig;
  Vector6d step;
  step << 0.12, -0.003, 0.01, 0.02, -0.3, 0.1;
  for (std::size_t i = 0; i < cameras; ++i) {
    RigCamera camera{fmt::format("cam{}", i), camera_with(distortion)};
    camera.camera.fx += static_cast<double>(i);
    if (i > 0) camera.T_rig_camera = rig.cameras.back().T_rig_camera * perturbation(step);
    rig.cameras.push_back(camera);
  }
  return rig;
}

// Largest distance of the two pixels of a grid of directions, px.
double largest_difference(const Camera& a, const Camera& b) {
  double largest = 0;
  for (double x = -0.6; x <= 0.6; x += 0.1) {
    for (double y = -0.5; y <= 0.5; y += 0.1) {
      const auto p = project(a, {x, y, 1}), q = project(b, {x, y, 1});
      if (p.has_value() != q.has_value()) return 1e9;
      if (p) largest = std::max(largest, (p->pixel - q->pixel).norm());
    }
  }
  return largest;
}

class CameraFormats : public testing::Test {
 protected:
  CameraRig round_trip(CameraFormat format, const CameraRig& rig) {
    const auto path =
        folder_ / fmt::format("{}.{}", to_string(format), format == CameraFormat::Colmap ? "txt" : "yaml");
    write_cameras_as(path, format, rig);
    return read_camera_rig(path);
  }
  std::string message(CameraFormat format, const CameraRig& rig) {
    return test::message_of(folder_.path(), [&] { write_cameras_as(folder_ / "out", format, rig); });
  }
  test::TemporaryDirectory folder_;
};

TEST_F(CameraFormats, KeepTheProjectionOfEveryLensThatTheyHold) {
  int held = 0;
  for (const CameraFormat format : kFormats) {
    for (const Distortion& lens : kLenses) {
      const CameraRig rig = rig_of(lens);
      if (find_obstacle(format, rig)) continue;
      const CameraRig back = round_trip(format, rig);
      ASSERT_EQ(back.cameras.size(), 1u);
      EXPECT_EQ(back.cameras[0].camera.width, 640);
      EXPECT_EQ(back.cameras[0].camera.height, 480);
      EXPECT_LT(largest_difference(back.cameras[0].camera, rig.cameras[0].camera), 1e-9) << to_string(format);
      ++held;
    }
  }
  EXPECT_EQ(held, 6 * 5 - 2 - 1);  // Kalibr has neither k3 nor a denominator, mrcal no such fisheye
}

TEST_F(CameraFormats, KeepThePosesThatTheyHold) {
  const auto expect_poses = [&](CameraFormat format, const CameraRig& rig) {
    const CameraRig back = round_trip(format, rig);
    ASSERT_EQ(back.cameras.size(), rig.cameras.size());
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      EXPECT_TRUE(back.cameras[i].T_rig_camera.isApprox(rig.cameras[i].T_rig_camera, 1e-12)) << to_string(format) << i;
      EXPECT_LT(largest_difference(back.cameras[i].camera, rig.cameras[i].camera), 1e-9);
    }
  };
  for (const Distortion& lens : {Distortion(kRadtan), Distortion(kFisheye)}) {
    expect_poses(CameraFormat::Alidade, rig_of(lens, 3));
    expect_poses(CameraFormat::Kalibr, rig_of(lens, 3));
    expect_poses(CameraFormat::OpenCv, rig_of(lens, 2));
  }
  expect_poses(CameraFormat::Mrcal, {{rig_of(kRational, 3).cameras[2]}});
}

TEST_F(CameraFormats, AreRefusedWhereTheyCannotHoldTheRig) {
  EXPECT_EQ(message(CameraFormat::Kalibr, rig_of(kRational)),
            "out: cannot be written: Kalibr has no rational distortion (k4, k5, k6) (camera 'cam0'); choose another "
            "format, or one of the cameras, or calibrate with a lens model that it has");
  EXPECT_EQ(find_obstacle(CameraFormat::Kalibr, rig_of(kFive)), "Kalibr's radtan has no k3 (camera 'cam0')");
  EXPECT_EQ(find_obstacle(CameraFormat::Mrcal, rig_of(kFisheye)),
            "mrcal has no model of this fisheye lens (camera 'cam0')");
  EXPECT_EQ(find_obstacle(CameraFormat::Mrcal, rig_of(kFive, 2)), "a file of format mrcal holds one camera, not 2");
  EXPECT_EQ(find_obstacle(CameraFormat::Ros, rig_of(kFive, 2)), "a file of format ros holds one camera, not 2");
  EXPECT_EQ(find_obstacle(CameraFormat::OpenCv, rig_of(kFive, 3)), "OpenCV's file holds one camera or two, not 3");
  CameraRig mixed = rig_of(kFive, 2);
  mixed.cameras[1].camera.distortion = kFisheye;
  EXPECT_EQ(find_obstacle(CameraFormat::OpenCv, mixed), "OpenCV's stereo file has one lens model for both");
  mixed.cameras[1].camera.width = 641;
  EXPECT_EQ(find_obstacle(CameraFormat::OpenCv, mixed), "OpenCV's stereo file has one image size for both cameras");
  mixed.cameras[1].name = "cam0";
  EXPECT_EQ(find_obstacle(CameraFormat::Alidade, mixed), "two cameras are named 'cam0'");
  EXPECT_THROW(format_cameras(CameraFormat::Alidade, {}), std::invalid_argument);
}

TEST_F(CameraFormats, SayWhatTheyLose) {
  CameraRig rig = rig_of(kRadtan, 2);
  EXPECT_TRUE(list_losses(CameraFormat::Kalibr, rig).empty());
  EXPECT_EQ(list_losses(CameraFormat::Colmap, rig), std::vector<std::string>{"poses on the rig"});
  rig.cameras[0].T_rig_camera.translation().x() = 1;
  EXPECT_EQ(list_losses(CameraFormat::OpenCv, rig),
            std::vector<std::string>{"the rig's frame (camera 'cam0' takes its place)"});
  rig.cameras[1].pose_covariance = Matrix6d::Identity();
  rig.cameras[1].clock_offset_s = 0.1;
  rig.cameras[1].camera.readout_s = 0.02;
  EXPECT_EQ(list_losses(CameraFormat::Mrcal, rig),
            (std::vector<std::string>{"covariances", "clock offsets", "read-out times"}));
  EXPECT_TRUE(list_losses(CameraFormat::Alidade, rig).empty());
}

TEST_F(CameraFormats, OpenCvReadsItsOwn) {
  const CameraRig rig = rig_of(kRational, 2);
  const cv::FileStorage file(format_cameras(CameraFormat::OpenCv, rig),
                             cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  cv::Mat M2, D2, T;
  file["M2"] >> M2;
  file["D2"] >> D2;
  file["T"] >> T;
  EXPECT_EQ(M2.at<double>(0, 0), rig.cameras[1].camera.fx);
  EXPECT_EQ(D2.at<double>(0, 7), kRational.k6);
  // x_right = R x_left + T: the left camera's centre as the right one sees it.
  const Eigen::Vector3d expected = rig.cameras[1].T_rig_camera.inverse().translation();
  EXPECT_NEAR(T.at<double>(0, 0), expected.x(), 1e-15);
  EXPECT_EQ(static_cast<int>(file["image_width"]), 640);
}

// As its documentation shows it.
constexpr const char* kCamchain =
    "cam0:\n  cam_overlaps: [1]\n  camera_model: pinhole\n  distortion_coeffs: [-0.2834, 0.0740, 0.0002, 0.00002]\n"
    "  distortion_model: radtan\n  intrinsics: [461.629, 460.152, 362.680, 246.049]\n  resolution: [752, 480]\n"
    "  rostopic: /cam0/image_raw\n  timeshift_cam_imu: 0.010\n"
    "cam1:\n  T_cn_cnm1:\n  - [1, 0, 0, -0.11]\n  - [0, 0, -1, 0.02]\n  - [0, 1, 0, 0.03]\n  - [0, 0, 0, 1]\n"
    "  camera_model: pinhole\n  distortion_coeffs: [0.01, 0.02, 0.03, 0.04]\n  distortion_model: equidistant\n"
    "  intrinsics: [460, 459, 356.6, 255.6]\n  resolution: [752, 480]\n  timeshift_cam_imu: 0.013\n";

TEST_F(CameraFormats, KalibrsChainIsRead) {
  const CameraRig rig = read_camera_rig(folder_.write("camchain.yaml", kCamchain));
  ASSERT_EQ(rig.cameras.size(), 2u);
  EXPECT_EQ(rig.cameras[0].camera,
            (Camera{752, 480, 461.629, 460.152, 362.68, 246.049, BrownConrady{-0.2834, 0.074, 0.0002, 0.00002}}));
  EXPECT_EQ(rig.cameras[1].camera, (Camera{752, 480, 460, 459, 356.6, 255.6, Fisheye{0.01, 0.02, 0.03, 0.04}}));
  EXPECT_EQ(rig.cameras[1].name, "cam1");
  // A point of the first camera at (0.11, 0, 0) is at (0, 0.02, 0.03) of the second.
  EXPECT_TRUE((rig.cameras[1].T_rig_camera * Eigen::Vector3d(0, 0.02, 0.03)).isApprox(Eigen::Vector3d(0.11, 0, 0)));
  EXPECT_NEAR(rig.cameras[1].clock_offset_s, 0.003, 1e-15);
}

TEST_F(CameraFormats, KalibrsChainIsRefusedByLine) {
  const auto message_with = [&](const std::string& from, const std::string& to) {
    std::string text = kCamchain;
    text.replace(text.find(from), from.size(), to);
    return test::message_of(folder_.path(), [&] { read_camera_rig(folder_.write("camchain.yaml", text)); });
  };
  EXPECT_EQ(message_with("pinhole", "omni"),
            "camchain.yaml:3: unknown or unsupported camera_model 'omni'; known are: pinhole");
  EXPECT_EQ(message_with("radtan", "fov"),
            "camchain.yaml:5: unknown or unsupported distortion_model 'fov'; known are: radtan, equidistant, none");
  EXPECT_EQ(message_with("[1, 0, 0, -0.11]", "[2, 0, 0, -0.11]"),
            "camchain.yaml:12: is no pose; a 3x3 rotation matrix and a translation in m are wanted");
  EXPECT_EQ(message_with("  - [0, 0, 0, 1]\n", ""),
            "camchain.yaml:12: is no pose; a 4x4 matrix [R t; 0 0 0 1] is wanted");
  EXPECT_EQ(message_with("461.629,", ""), "camchain.yaml:6: a list of 4 numbers is wanted here; e.g. [fu, fv, pu, pv]");
  EXPECT_EQ(message_with("461.629", "-461"),
            "camchain.yaml:6: camera 'cam0': fx must be > 0 px, got -461; correct the file or calibrate the camera "
            "again");
}

// As mrcal 2.2 writes it, with the data of its optimization behind.
constexpr const char* kCameramodel =
    "# written by mrcal\n{\n    'lensmodel':  'LENSMODEL_OPENCV4',\n\n"
    "    # intrinsics are fx,fy,cx,cy,distortion0,distortion1,....\n"
    "    'intrinsics': [ 500.5, 501, 320, 240, 0.1, -0.02, 0.001, 0.002,],\n\n    # extrinsics are rt_fromref\n"
    "    'extrinsics': [ 0, 0, 1.570796326794896558, 1, 2, 3,],\n\n    'imagersize': [ 640, 480,],\n"
    "    'icam_intrinsics': 0,\n"
    "    'optimization_inputs': b'P)h>@6aWAK2mk{v#Ka<;O{00*2b}:{+',\n}\n";

TEST_F(CameraFormats, MrcalsModelIsRead) {
  const CameraRig rig = read_camera_rig(folder_.write("front.cameramodel", kCameramodel));
  ASSERT_EQ(rig.cameras.size(), 1u);
  EXPECT_EQ(rig.cameras[0].name, "front");
  EXPECT_EQ(rig.cameras[0].camera, (Camera{640, 480, 500.5, 501, 320, 240, BrownConrady{0.1, -0.02, 0.001, 0.002}}));
  // The reference's origin is at (1, 2, 3) of the camera, its x axis along the camera's y.
  const Eigen::Isometry3d T_camera_rig = rig.cameras[0].T_rig_camera.inverse();
  EXPECT_TRUE((T_camera_rig * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3)));
}

TEST_F(CameraFormats, MrcalsModelIsRefusedByLine) {
  const auto message_with = [&](const std::string& from, const std::string& to) {
    std::string text =
        "{\n 'lensmodel': 'LENSMODEL_OPENCV12',\n 'intrinsics': [5, 5, 3, 2, 1,2,3,4,5,6,7,8, 0,0,0,0,],\n"
        " 'extrinsics': [0,0,0,0,0,0],\n 'imagersize': [8, 6],\n}\n";
    text.replace(text.find(from), from.size(), to);
    return test::message_of(folder_.path(), [&] { read_camera_rig(folder_.write("a.cameramodel", text)); });
  };
  EXPECT_EQ(message_with("8, 0,0", "8, 0,0"), "(nothing thrown)");
  EXPECT_EQ(message_with("8, 0,0", "8, 0,1"),
            "a.cameramodel:3: distortion with 12 coefficients is not supported; calibrate with k1 k2 p1 p2 k3 k4 k5 "
            "k6, without thin prisms and tilt");
  EXPECT_EQ(message_with("OPENCV12", "CAHVOR"),
            "a.cameramodel:2: unknown or unsupported lensmodel 'LENSMODEL_CAHVOR'; known are: LENSMODEL_PINHOLE, "
            "LENSMODEL_OPENCV4, LENSMODEL_OPENCV5, LENSMODEL_OPENCV8, LENSMODEL_OPENCV12");
  EXPECT_EQ(message_with("OPENCV12", "OPENCV8"),
            "a.cameramodel:3: a list of 12 numbers is wanted here; e.g. [fx, fy, cx, cy, k1, k2, ...]");
  EXPECT_EQ(message_with("'imagersize'", "'imagersise'"), "a.cameramodel:1: the camera model has no 'imagersize'");
  EXPECT_EQ(message_with("[0,0,0,0,0,0]", "[0,0,0]"),
            "a.cameramodel:4: a list of 6 numbers is wanted here; e.g. [rx, ry, rz, tx, ty, tz]");
}

TEST_F(CameraFormats, OpenCvsXmlPosesTheRightCamera) {
  const auto matrix = [](const char* name, const char* data) {
    return fmt::format("<{0} type_id=\"opencv-matrix\">\n<data>{1}</data></{0}>\n", name, data);
  };
  const std::string text =
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>640</image_width>\n"
      "<image_height>480</image_height>\n" +
      matrix("M1", "500 0 320 0 500 240 0 0 1") + matrix("D1", "0.1 0") + matrix("M2", "501 0 320 0 501 240 0 0 1") +
      matrix("D2", "0.2 0") + matrix("R", "1 0 0 0 1 0 0 0 1") + matrix("T", "-0.12 0 0.01") + "</opencv_storage>\n";
  const CameraRig rig = read_camera_rig(folder_.write("stereo.xml", text));
  ASSERT_EQ(rig.cameras.size(), 2u);
  EXPECT_EQ(rig.cameras[1].name, "right");
  EXPECT_EQ(rig.cameras[1].T_rig_camera.translation(), Eigen::Vector3d(0.12, 0, -0.01));
}

}  // namespace
}  // namespace alidade
