// SPDX-License-Identifier: Apache-2.0
#include "tracking/anchor_follower.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace alidade {
namespace {

const Camera kCamera{240, 180, 200, 200, 119.5, 89.5, {}};
constexpr double kDepth = 2.0;  // m, of a wall that the camera faces
constexpr double kStep = 0.02;  // m to the right per frame: 2 px

double centre_x(int frame) {
  return kStep * frame;
}

Timestamp time_of(int frame) {
  return Timestamp(std::chrono::milliseconds(33 * frame));
}

Eigen::Isometry3d pose_at(int frame) {
  return Eigen::Isometry3d(Eigen::Translation3d(centre_x(frame), 0, 0));
}

// The wall is painted with waves, so that every pixel of every frame is known exactly.
cv::Mat wall_from(int frame) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> direction(0, 2 * M_PI), length_px(10, 40), phase(0, 2 * M_PI);
  const double shift_px = kCamera.fx * centre_x(frame) / kDepth;
  cv::Mat sum(kCamera.height, kCamera.width, CV_64F, cv::Scalar(128));
  for (int wave = 0; wave < 12; ++wave) {
    const double angle = direction(random), k = 2 * M_PI / length_px(random), at_zero = phase(random);
    for (int v = 0; v < sum.rows; ++v) {
      for (int u = 0; u < sum.cols; ++u) {
        sum.at<double>(v, u) += 14 * std::sin(k * (std::cos(angle) * (u + shift_px) + std::sin(angle) * v) + at_zero);
      }
    }
  }
  cv::Mat grey;
  sum.convertTo(grey, CV_8U);
  return grey;
}

ImageFrame image_of(int frame, cv::Mat grey) {
  ImageFrame image;
  image.index = frame;
  image.time = time_of(frame);
  image.grey = std::move(grey);
  return image;
}

// What a tracker would know of a frame; its world may begin elsewhere.
TrackAnchor anchor_at(int frame, double world_x = 0) {
  TrackAnchor anchor;
  anchor.time = time_of(frame);
  anchor.image = make_flow_image(wall_from(frame));
  anchor.sigma_px = 0.3;
  const Eigen::Translation3d T_world_wall(world_x, 0, 0);
  const Matrix6d covariance = 1e-6 * Matrix6d::Identity();
  anchor.motion.start({time_of(frame - 1), T_world_wall * pose_at(frame - 1), covariance},
                      {time_of(frame), T_world_wall * pose_at(frame), covariance}, 0.033);
  for (double v = 20; v < 170; v += 12) {
    for (double u = 40; u < 220; u += 12) {
      const Eigen::Vector3d p_camera((u - kCamera.cx) / kCamera.fx * kDepth, (v - kCamera.cy) / kCamera.fy * kDepth,
                                     kDepth);
      MapPoint point;
      point.p_world = T_world_wall * (pose_at(frame) * p_camera);
      point.covariance_world = 1e-8 * Eigen::Matrix3d::Identity();
      anchor.tracks.push_back({1000 + static_cast<int>(anchor.points.size()), -1, {u, v}});
      anchor.points.push_back(point);
    }
  }
  return anchor;
}

double error_m(const FrameReport& report, int frame, double world_x = 0) {
  return (report.T_world_camera.translation() - Eigen::Vector3d(world_x + centre_x(frame), 0, 0)).norm();
}

TEST(AnchorFollower, WaitsForItsFirstAnchor) {
  AnchorFollower follower(kCamera, {});
  const FrameReport report = follower.step(image_of(0, wall_from(0)), "no parallax yet");
  EXPECT_EQ(report.state, FrameState::Waiting);
  EXPECT_EQ(report.reason, "no parallax yet");
}

TEST(AnchorFollower, FollowsFromAnAnchorThatCameLate) {
  AnchorFollower follower(kCamera, {});
  follower.put(anchor_at(0));
  for (int frame = 4; frame < 12; ++frame) {
    const FrameReport report = follower.step(image_of(frame, wall_from(frame)), "");
    ASSERT_EQ(report.state, FrameState::Tracked) << frame;
    EXPECT_LT(error_m(report, frame), 2e-3) << frame;
    EXPECT_GT(report.inlier_count, 60);
    EXPECT_GE(report.sightings.front().point, 1000);  // counts in the tracker's map
    EXPECT_EQ(report.expectations.size(), report.sightings.size());
  }
}

TEST(AnchorFollower, GoesByTheAnchorsPoseAndNotByTheNoiseOfWhatIsFollowed) {
  AnchorFollower follower(kCamera, {});
  TrackAnchor anchor = anchor_at(0);
  for (FoundPoint& track : anchor.tracks) track.pixel.x() += 1.5;  // as if the camera were elsewhere
  follower.put(std::move(anchor));
  const FrameReport report = follower.step(image_of(1, wall_from(1)), "");
  ASSERT_EQ(report.state, FrameState::Tracked);
  EXPECT_LT(error_m(report, 1), 2e-3);
}

TEST(AnchorFollower, TakesTheWorldOfANewerAnchor) {
  AnchorFollower follower(kCamera, {});
  follower.put(anchor_at(0));
  for (int frame = 1; frame < 5; ++frame) follower.step(image_of(frame, wall_from(frame)), "");
  follower.put(anchor_at(2, 0.5));
  const FrameReport report = follower.step(image_of(5, wall_from(5)), "");
  ASSERT_EQ(report.state, FrameState::Tracked);
  EXPECT_LT(error_m(report, 5, 0.5), 2e-3);
}

TEST(AnchorFollower, PredictsThenIsLostAndIsFoundByTheNextAnchor) {
  CameraTrackerOptions options;
  options.most_predicted = 2;
  AnchorFollower follower(kCamera, options);
  follower.put(anchor_at(0));
  follower.step(image_of(1, wall_from(1)), "");
  const cv::Mat black(kCamera.height, kCamera.width, CV_8U, cv::Scalar(0));
  for (const FrameState expected : {FrameState::Predicted, FrameState::Predicted, FrameState::Lost}) {
    const FrameReport report = follower.step(image_of(2, black), "");
    EXPECT_EQ(report.state, expected);
    EXPECT_FALSE(report.reason.empty());
  }
  follower.put(anchor_at(6));
  const FrameReport found = follower.step(image_of(8, wall_from(8)), "");
  ASSERT_EQ(found.state, FrameState::Tracked);
  EXPECT_LT(error_m(found, 8), 2e-3);
}

TEST(AnchorFollower, IsLedThroughTheFramesSinceAnAnchorThatCameVeryLate) {
  AnchorFollower follower(kCamera, {});
  for (int frame = 1; frame < 20; ++frame) follower.step(image_of(frame, wall_from(frame)), "");
  follower.put(anchor_at(0));
  for (int frame = 20; frame < 22; ++frame) follower.step(image_of(frame, wall_from(frame)), "");
  const FrameReport report = follower.step(image_of(22, wall_from(22)), "");
  ASSERT_EQ(report.state, FrameState::Tracked);
  EXPECT_LT(error_m(report, 22), 5e-3);
}

TEST(AnchorFollower, HandsOnTheFrameThatItMeasuredLast) {
  AnchorFollower follower(kCamera, {});
  EXPECT_FALSE(follower.last().has_value());
  follower.put(anchor_at(0));
  const FrameReport report = follower.step(image_of(1, wall_from(1)), "");
  const auto last = follower.last();
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(last->time, time_of(1));
  EXPECT_EQ(static_cast<int>(last->tracks.size()), report.inlier_count);
  follower.step(image_of(2, cv::Mat(kCamera.height, kCamera.width, CV_8U, cv::Scalar(0))), "");
  EXPECT_FALSE(follower.last().has_value());
}

TEST(AnchorFollower, FollowsNoMorePointsThanItMay) {
  CameraTrackerOptions options;
  options.most_tracks = 50;
  AnchorFollower follower(kCamera, options);
  follower.put(anchor_at(0));
  EXPECT_LE(follower.step(image_of(1, wall_from(1)), "").sightings.size(), 50u);
}

}  // namespace
}  // namespace alidade
