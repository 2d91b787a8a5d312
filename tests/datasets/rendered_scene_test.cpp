// SPDX-License-Identifier: Apache-2.0
#include "datasets/rendered_scene.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/pose.h"

namespace alidade {
namespace {

RenderedSceneOptions small() {
  RenderedSceneOptions options;
  options.camera = {320, 240, 262, 258, 150.4, 122.7, {}};
  options.frames = 60;
  options.noise_grey = 0;
  options.supersampling = 1;
  return options;
}

double mean_difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * std::size_t(a.channels()));
}

// Looks up frame b's picture and depth at what frame a sees, by the true poses: what both see must look alike. Any
// slip between picture, depth, camera and truth blurs the textures apart.
struct Reprojection {
  double share_seen;
  double mean_grey;
};

Reprojection reproject(RenderedScene& scene, int a, int b, double slip_px) {
  const cv::Mat image_a = scene.frame(a), image_b = scene.frame(b), depth_a = scene.depth(a), depth_b = scene.depth(b);
  const Eigen::Isometry3d T_b_a = scene.T_world_camera(b).inverse() * scene.T_world_camera(a);
  cv::Mat map(image_a.size(), CV_32FC2, cv::Scalar::all(-1)), seen = cv::Mat::zeros(image_a.size(), CV_8UC1);
  for (int y = 0; y < map.rows; ++y) {
    for (int x = 0; x < map.cols; ++x) {
      const auto xy = undistort(scene.camera(), Eigen::Vector2d(x, y));
      const Eigen::Vector3d p_b = T_b_a * (double(depth_a.at<float>(y, x)) * Eigen::Vector3d(xy->homogeneous()));
      const auto at = project(scene.camera(), p_b);
      if (!at || !is_inside(scene.camera(), at->pixel, 1)) continue;
      const float other = depth_b.at<float>(int(std::lround(at->pixel.y())), int(std::lround(at->pixel.x())));
      if (std::abs(other - p_b.z()) > 0.02) continue;
      map.at<cv::Vec2f>(y, x) = {float(at->pixel.x() + slip_px), float(at->pixel.y())};
      seen.at<unsigned char>(y, x) = 255;
    }
  }
  cv::Mat warped, difference;
  cv::remap(image_b, warped, map, {}, cv::INTER_LINEAR);
  cv::absdiff(image_a, warped, difference);
  cv::cvtColor(difference, difference, cv::COLOR_BGR2GRAY);
  return {cv::countNonZero(seen) / double(seen.total()), cv::mean(difference, seen)[0]};
}

TEST(RenderedScene, PicturesDepthsAndTruthAgree) {
  RenderedSceneOptions options = small();
  options.supersampling = 2;
  RenderedScene scene(options);
  const Reprojection exact = reproject(scene, 0, 6, 0.0);
  EXPECT_GT(exact.share_seen, 0.6);
  for (const double slip_px : {-0.5, 0.5}) {
    EXPECT_GT(reproject(scene, 0, 6, slip_px).mean_grey, 1.15 * exact.mean_grey) << slip_px;
  }
}

TEST(RenderedScene, PicturesDepthsAndTruthAgreeThroughADistortingLens) {
  RenderedSceneOptions options = small();
  options.camera.distortion = BrownConrady{-0.25, 0.06, 0.001, -0.002, 0};
  options.supersampling = 2;
  RenderedScene scene(options);
  const Reprojection exact = reproject(scene, 0, 6, 0.0);
  EXPECT_GT(exact.share_seen, 0.6);
  for (const double slip_px : {-0.5, 0.5}) {
    EXPECT_GT(reproject(scene, 0, 6, slip_px).mean_grey, 1.15 * exact.mean_grey) << slip_px;
  }
}

TEST(RenderedScene, MarkerIsSeenWhereItIsSaidToBe) {
  RenderedSceneOptions options = small();
  options.camera = {640, 480, 520, 510, 310.2, 245.9, BrownConrady{-0.1, 0.02, 0, 0, 0}};
  options.marker_m = 0.2;
  options.supersampling = 2;
  RenderedScene scene(options);
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  cv::aruco::detectMarkers(scene.frame(0), cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11), corners,
                           ids, parameters);
  ASSERT_EQ(ids, std::vector<int>{0});
  const Eigen::Isometry3d T_camera_marker = scene.T_world_camera(0).inverse() * *scene.T_world_marker();
  const std::vector<Eigen::Vector2d> order{{-0.1, 0.1}, {0.1, 0.1}, {0.1, -0.1}, {-0.1, -0.1}};  // OpenCV's
  for (std::size_t i = 0; i < 4; ++i) {
    const auto expected = project(scene.camera(), T_camera_marker * Eigen::Vector3d(order[i].x(), order[i].y(), 0));
    EXPECT_NEAR(corners[0][i].x, expected->pixel.x(), 0.3) << i;
    EXPECT_NEAR(corners[0][i].y, expected->pixel.y(), 0.3) << i;
  }
}

TEST(RenderedScene, HasPlentyOfFeaturesInEveryFrame) {
  RenderedSceneOptions options = small();
  options.frames = 600;
  RenderedScene scene(options);
  for (int i = 0; i < 600; i += 50) {
    std::vector<cv::KeyPoint> features;
    cv::SIFT::create()->detect(scene.frame(i), features);
    EXPECT_GT(features.size(), 500u) << i;
  }
}

TEST(RenderedScene, SeesNoHoleAnywhere) {
  for (const PathKind path : {PathKind::Orbit, PathKind::Sweep, PathKind::Rotation}) {
    RenderedSceneOptions options = small();
    options.path = path;
    options.frames = 600;
    RenderedScene scene(options);
    for (int i = 0; i < 600; i += 60) {
      double nearest = 0, farthest = 0;
      cv::minMaxLoc(scene.depth(i), &nearest, &farthest);
      EXPECT_GT(nearest, 0.2) << i;
      EXPECT_LT(farthest, 8) << i;
    }
  }
}

TEST(RenderedScene, GivesTheSameBytesInAnyOrder) {
  RenderedSceneOptions options = small();
  options.noise_grey = 3;
  RenderedScene first(options), second(options);
  const cv::Mat a = first.frame(4), b = first.frame(9);
  EXPECT_EQ(cv::norm(second.frame(9), b, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(second.frame(4), a, cv::NORM_INF), 0);
  options.seed = 2;
  EXPECT_GT(mean_difference(RenderedScene(options).frame(4), a), 10);
}

TEST(RenderedScene, NoiseHasItsStandardDeviation) {
  RenderedSceneOptions options = small();
  RenderedScene clean(options);
  options.noise_grey = 4;
  RenderedScene noisy(options);
  cv::Mat difference;
  cv::subtract(noisy.frame(7), clean.frame(7), difference, cv::noArray(), CV_32FC3);
  cv::Scalar mean, deviation;
  cv::meanStdDev(difference.reshape(1), mean, deviation);
  EXPECT_NEAR(mean[0], 0, 0.15);
  EXPECT_NEAR(deviation[0], 4, 0.2);
}

TEST(RenderedScene, BlurIsTheMeanRoundTheTimestamp) {
  RenderedSceneOptions options = small();
  options.path = PathKind::Rotation;
  options.speed_m_s = 0.8;  // rad/s: 6 px in 30 ms
  RenderedScene sharp(options);
  options.exposure_s = 0.03;
  RenderedScene blurred(options);
  const auto sharpness = [](const cv::Mat& image) {
    cv::Mat laplacian;
    cv::Laplacian(image, laplacian, CV_32F);
    return cv::norm(laplacian);
  };
  const cv::Mat image = blurred.frame(20);
  EXPECT_LT(sharpness(image), 0.6 * sharpness(sharp.frame(20)));
  // Nearer to the sharp frame of its own time than to those half an exposure away.
  options.exposure_s = 0;
  options.fps_hz = 30 * 8;
  options.frames = 480;
  RenderedScene dense(options);
  const double own = mean_difference(dense.frame(160), image);
  EXPECT_LT(own, mean_difference(dense.frame(157), image));
  EXPECT_LT(own, mean_difference(dense.frame(163), image));
}

TEST(RenderedScene, BlackFramesAreBlackAndTheOthersAreNot) {
  RenderedSceneOptions options = small();
  options.black_from = 3;
  options.black_count = 2;
  RenderedScene scene(options);
  for (int i = 2; i < 6; ++i) EXPECT_EQ(cv::mean(scene.frame(i))[0] == 0, i == 3 || i == 4) << i;
  EXPECT_EQ(scene.truth().size(), 60u);
}

TEST(RenderedScene, TruthHasTheTimesAndPosesOfTheFrames) {
  RenderedScene scene(small());
  const Trajectory truth = scene.truth();
  EXPECT_EQ(truth[30].time.time_since_epoch().count(), 1'000'000'000);
  EXPECT_TRUE(truth[17].T_world_camera.isApprox(scene.T_world_camera(17)));
  EXPECT_THROW(scene.frame(60), std::invalid_argument);
  EXPECT_THROW(scene.time(-1), std::invalid_argument);
}

TEST(RenderedScene, RefusesImpossibleOptionsByName) {
  const auto message = [](auto change) -> std::string {
    RenderedSceneOptions options = small();
    change(options);
    try {
      validate(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([](auto& o) { o.frames = 0; }), "frames must be >= 1, got 0");
  EXPECT_EQ(message([](auto& o) { o.fps_hz = -1; }), "fps_hz must be > 0 and <= 1e6 Hz, got -1");
  EXPECT_EQ(message([](auto& o) { o.noise_grey = std::nan(""); }), "noise_grey must be 0..255, got nan");
  EXPECT_EQ(message([](auto& o) { o.exposure_s = 1; }), "exposure_s must be >= 0 s and not longer than a frame, got 1");
  EXPECT_EQ(message([](auto& o) { o.camera.fx = -3; }), "fx must be > 0 px, got -3");
  EXPECT_EQ(message([](auto&) {}), "");
}

}  // namespace
}  // namespace alidade
