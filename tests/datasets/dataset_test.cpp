// SPDX-License-Identifier: Apache-2.0
#include "datasets/dataset.h"

#include <gtest/gtest.h>

#include "io/image_files.h"
#include "tests/support/data_directory.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

class DatasetFolder : public testing::Test {
 protected:
  void add_image(const std::string& name) { write_image(folder_ / name, cv::Mat(24, 32, CV_8UC1, cv::Scalar(9))); }
  std::string message() {
    return test::message_of(folder_.path(), [&] { open_dataset(folder_.path()); });
  }
  test::TemporaryDirectory folder_;
};

constexpr const char* kStrecha = "50 0 16\n0 50 12\n0 0 1\n0 0 0\n0 0 1\n1 0 0\n0 1 0\n1 2 3\n32 24\n";

TEST_F(DatasetFolder, OfStrechaTurnsCameraToWorld) {
  add_image("0.jpg");
  folder_.write("0.jpg.camera", kStrecha);
  const auto dataset = open_dataset(folder_.path());
  ASSERT_TRUE(dataset);
  EXPECT_EQ(dataset->kind, "strecha");
  EXPECT_FALSE(dataset->timed);
  EXPECT_EQ(dataset->camera, (Camera{32, 24, 50, 50, 16, 12, {}}));
  // The file's R takes the camera's x axis to the world's y axis; the centre is C.
  const Eigen::Isometry3d T_world_camera = dataset->frames.at(0).T_world_camera.value();
  EXPECT_TRUE((T_world_camera * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));
}

TEST_F(DatasetFolder, OfStrechaNamesTheMissingImage) {
  folder_.write("0.jpg.camera", kStrecha);
  EXPECT_EQ(message(), "0.jpg.camera: its image '0.jpg' is missing");
  add_image("0.jpg");
  folder_.write("0.jpg.camera", "50 0 16\n0 50 12\n0 0 1\n0 0 0\n2 0 1\n1 0 0\n0 1 0\n1 2 3\n32 24\n");
  EXPECT_EQ(
      message(),
      "0.jpg.camera:5: the 3x3 part of the pose is not a rotation; check the order of the numbers (rows of [R t]) and "
      "that no scale is in it");
}

TEST_F(DatasetFolder, OfSevenScenesCountsThirtyFramesPerSecond) {
  add_image("frame-000000.color.png");
  add_image("frame-000015.color.png");
  folder_.write("frame-000000.pose.txt", "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n");
  folder_.write("frame-000015.pose.txt", "-1.#IND 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n");
  folder_.write("camera.txt", "fx 50 fy 50 cx 16 cy 12\n");
  const auto dataset = open_dataset(folder_.path());
  ASSERT_TRUE(dataset);
  EXPECT_EQ(dataset->kind, "seven-scenes");
  EXPECT_TRUE(dataset->timed);
  ASSERT_EQ(dataset->frames.size(), 2u);
  EXPECT_EQ(dataset->frames[1].time, Timestamp(std::chrono::milliseconds(500)));
  EXPECT_EQ(dataset->frames[0].T_world_camera->translation(), Eigen::Vector3d(5, 6, 7));
  EXPECT_FALSE(dataset->frames[1].T_world_camera) << "the fusion had lost track";
  EXPECT_EQ(dataset->truth.size(), 1u);
  EXPECT_EQ(dataset->camera->width, 32);
  folder_.write("frame-000015.pose.txt", "1 0 0 5\n0 1 0\n0 0 1 7\n0 0 0 1\n");
  EXPECT_EQ(message(),
            "frame-000015.pose.txt:2: has 3 columns, a row of a 4x4 pose has 4; copy the file again from its source");
}

TEST_F(DatasetFolder, OfKittiMovesTheTruthToTheColourCamera) {
  std::filesystem::create_directory(folder_ / "image_2");
  add_image("image_2/000000.png");
  add_image("image_2/000001.png");
  // P2 = K [1 | K⁻¹ p₄] with K⁻¹ p₄ = (0.06, 0, 0): the camera stands 0.06 m left of camera 0.
  folder_.write("calib.txt",
                "P0: 50 0 16 0 0 50 12 0 0 0 1 0\nP1: 50 0 16 -9 0 50 12 0 0 0 1 0\nP2: 50 0 16 3 0 50 12 0 0 0 1 0\n");
  folder_.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n");
  const auto dataset = open_dataset(folder_.path());
  ASSERT_TRUE(dataset);
  EXPECT_EQ(dataset->kind, "kitti");
  EXPECT_EQ(dataset->frames[1].time, Timestamp(std::chrono::milliseconds(100)));
  EXPECT_TRUE(dataset->truth[1].T_world_camera.translation().isApprox(Eigen::Vector3d(-0.06, 0, 2), 1e-12));
  folder_.write("times.txt", "0.0\n1.036e-01\n");
  EXPECT_EQ(open_dataset(folder_.path())->frames[1].time, Timestamp(std::chrono::microseconds(103600)));
  folder_.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(message(), "poses.txt: has 1 poses for 2 images");
  folder_.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_TRUE(message().starts_with("poses.txt:1: has 11 columns, which is no known trajectory format")) << message();
}

TEST_F(DatasetFolder, OfTumInterpolatesTruthAndPairsDepth) {
  for (const char* name : {"10.00.png", "10.04.png", "10.50.png"}) add_image(name);
  write_image(folder_ / "depth.png", cv::Mat(24, 32, CV_16UC1, cv::Scalar(5000)));
  folder_.write("rgb.txt", "# timestamp filename\n10.00 10.00.png\n10.04 10.04.png\n10.50 10.50.png\n");
  folder_.write("depth.txt", "10.03 depth.png\n");
  folder_.write("groundtruth.txt", "9.98 0 0 0 0 0 0 1\n10.02 4 0 0 0 0 0 1\n10.06 8 0 0 0 0 0 1\n");
  const auto dataset = open_dataset(folder_.path());
  ASSERT_TRUE(dataset);
  EXPECT_EQ(dataset->kind, "tum-rgbd");
  EXPECT_EQ(dataset->depth_unit_m, 1.0 / 5000);
  EXPECT_NEAR(dataset->frames[0].T_world_camera->translation().x(), 2.0, 1e-9);
  EXPECT_NEAR(dataset->frames[1].T_world_camera->translation().x(), 6.0, 1e-9);
  EXPECT_FALSE(dataset->frames[2].T_world_camera) << "beyond the truth";
  EXPECT_FALSE(dataset->frames[0].depth);
  EXPECT_TRUE(dataset->frames[1].depth);
  EXPECT_FALSE(dataset->camera);
  folder_.write("rgb.txt", "10.00 10.00.png\n10.04 gone.png\n");
  EXPECT_EQ(message(), "rgb.txt:2: there is no file 'gone.png'");
  folder_.write("rgb.txt", "10.00 10.00.png\n");
  folder_.write("groundtruth.txt", "9.98 0 0 0 0 0 0 2\n");
  EXPECT_EQ(message(),
            "groundtruth.txt:1: the quaternion's norm must be 1, got 2; check the columns' order and remove lines "
            "without a pose");
}

TEST_F(DatasetFolder, OfOtherThingsIsNone) {
  add_image("0.jpg");
  EXPECT_FALSE(open_dataset(folder_.path()));
  EXPECT_FALSE(open_dataset(folder_ / "none"));
}

struct Expected {
  const char* folder;
  const char* kind;
  std::size_t frames;
  std::size_t with_truth;
  std::size_t with_depth;
  double fx;
  double path_m;  // of the truth at the frames
};

class RealDataset : public testing::TestWithParam<Expected> {};

TEST_P(RealDataset, IsRecognised) {
  const auto folder = test::data_directory(GetParam().folder);
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto dataset = open_dataset(folder);
  ASSERT_TRUE(dataset);
  EXPECT_EQ(dataset->kind, GetParam().kind);
  EXPECT_EQ(dataset->frames.size(), GetParam().frames);
  EXPECT_EQ(dataset->camera.value().fx, GetParam().fx);
  std::size_t depths = 0;
  Trajectory truth;
  for (const DatasetFrame& frame : dataset->frames) {
    depths += frame.depth.has_value();
    if (frame.T_world_camera) truth.push_back({frame.time, *frame.T_world_camera, std::nullopt});
  }
  EXPECT_EQ(truth.size(), GetParam().with_truth);
  EXPECT_EQ(depths, GetParam().with_depth);
  EXPECT_NEAR(path_length(truth), GetParam().path_m, 0.02 * GetParam().path_m);
  const auto source = open_frames(*dataset);
  EXPECT_EQ(source->frame_count(), static_cast<int>(GetParam().frames));
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->image.cols, dataset->camera->width);
}

INSTANTIATE_TEST_SUITE_P(Shared, RealDataset,
                         testing::Values(Expected{"fountain", "strecha", 11, 11, 0, 1379.74, 16.952},
                                         Expected{"seven-scenes", "seven-scenes", 400, 400, 0, 518.8, 3.0},
                                         Expected{"kitti-clip", "kitti", 51, 51, 0, 707.0912, 60.0},
                                         Expected{"tum-fr1-rpy", "tum-rgbd", 240, 240, 24, 517.3, 0.74}));

}  // namespace
}  // namespace alidade
