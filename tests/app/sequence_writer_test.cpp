// SPDX-License-Identifier: Apache-2.0
#include "app/sequence_writer.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "capture/file_sources.h"
#include "datasets/dataset.h"
#include "io/camera_file.h"
#include "io/image_files.h"
#include "io/trajectory_file.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

const Camera kCamera{64, 48, 50, 51, 31.5, 23.5, BrownConrady{-0.1}};

StampedPose pose_at_frame(int i) {
  StampedPose pose;
  pose.time = Timestamp(i * 40ms);
  pose.T_world_camera.translation() = Eigen::Vector3d(0.1 * i, 0, 1);
  return pose;
}

cv::Mat image_of_frame(int i) {
  return {48, 64, CV_8UC3, cv::Scalar(10 * i, 100, 50)};
}

// Writes three frames and returns where they are.
std::filesystem::path write_sequence(const std::filesystem::path& out, SequenceForm form, bool with_depth) {
  ResultDirectory directory(out, "simulate camera");
  SequenceWriter writer(directory, kCamera, form, 25.0);
  for (int i = 0; i < 3; ++i) {
    std::optional<cv::Mat> depth;
    if (with_depth) depth = cv::Mat(48, 64, CV_32FC1, cv::Scalar(1.5 + i));
    writer.add(image_of_frame(i), pose_at_frame(i), depth);
  }
  writer.finish();
  directory.commit(nlohmann::json::object());
  return out;
}

TEST(SequenceWriter, ImagesAreReadBackWithTimesCameraAndTruth) {
  const test::TemporaryDirectory temporary;
  const auto out = write_sequence(temporary.path() / "s", SequenceForm::Images, false);
  const auto source = open_files(out.string());
  EXPECT_TRUE(source->has_times());
  for (int i = 0; i < 3; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->time, pose_at_frame(i).time);
    EXPECT_EQ(cv::norm(frame->image, image_of_frame(i), cv::NORM_INF), 0);
  }
  EXPECT_FALSE(source->next());
  EXPECT_EQ(read_camera(out / "camera.yaml"), kCamera);
  const Trajectory truth = read_trajectory(out / "truth.tum").poses;
  ASSERT_EQ(truth.size(), 3u);
  EXPECT_EQ(truth[2].time, pose_at_frame(2).time);
  EXPECT_TRUE(truth[2].T_world_camera.isApprox(pose_at_frame(2).T_world_camera));
}

TEST(SequenceWriter, ALosslessVideoKeepsEveryPixel) {
  const test::TemporaryDirectory temporary;
  const auto out = write_sequence(temporary.path() / "s", SequenceForm::Lossless, false);
  const auto source = open_video(out / "video.mkv");
  for (int i = 0; i < 3; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(cv::norm(frame->image, image_of_frame(i), cv::NORM_INF), 0);
    EXPECT_EQ(frame->time.time_since_epoch(), i * 40ms);
  }
}

TEST(SequenceWriter, WithDepthItIsADataSet) {
  const test::TemporaryDirectory temporary;
  const auto out = write_sequence(temporary.path() / "s", SequenceForm::Images, true);
  const auto dataset = open_dataset(out);
  ASSERT_TRUE(dataset);
  EXPECT_EQ(dataset->kind, "tum-rgbd");
  ASSERT_EQ(dataset->frames.size(), 3u);
  EXPECT_EQ(dataset->camera, kCamera);
  ASSERT_TRUE(dataset->frames[1].depth && dataset->frames[1].T_world_camera);
  EXPECT_TRUE(dataset->frames[1].T_world_camera->isApprox(pose_at_frame(1).T_world_camera));
  EXPECT_NEAR(read_depth(*dataset->frames[1].depth).at<std::uint16_t>(5, 5) * dataset->depth_unit_m, 2.5, 1e-9);
}

TEST(SequenceWriter, RefusesDepthForSomeFramesOnlyOrInAVideo) {
  const test::TemporaryDirectory temporary;
  ResultDirectory directory(temporary.path() / "s", "simulate camera");
  const cv::Mat depth(48, 64, CV_32FC1, cv::Scalar(1));
  SequenceWriter images(directory, kCamera, SequenceForm::Images, 25.0);
  images.add(image_of_frame(0), pose_at_frame(0), std::nullopt);
  EXPECT_THROW(images.add(image_of_frame(1), pose_at_frame(1), depth), std::invalid_argument);
  SequenceWriter video(directory, kCamera, SequenceForm::Movie, 25.0);
  EXPECT_THROW(video.add(image_of_frame(0), pose_at_frame(0), depth), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
