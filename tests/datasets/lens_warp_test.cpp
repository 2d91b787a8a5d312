// SPDX-License-Identifier: Apache-2.0
#include "datasets/lens_warp.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

Camera lens(double k1, double k2) {
  Camera camera{320, 240, 250, 260, 170.3, 112.6, BrownConrady{k1, k2, 0.002, -0.001, 0}};
  return camera;
}

class EveryLens : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(EveryLens, PutsAPointWhereProjectSays) {
  const Camera camera = lens(GetParam().first, GetParam().second);
  for (int supersampling : {1, 2}) {
    const LensWarp warp(camera, supersampling);
    const Camera large = resized(warp.pinhole(), supersampling);
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(0.1, 0.2, 1), Eigen::Vector3d(-0.5, -0.3, 1), Eigen::Vector3d(0.45, 0.35, 1)}) {
      cv::Mat picture = cv::Mat::zeros(large.height, large.width, CV_8UC3);
      const Eigen::Vector2d at = project(large, p)->pixel;
      cv::circle(picture, {int(std::lround(at.x() * 16)), int(std::lround(at.y() * 16))}, 3 * supersampling * 16,
                 cv::Scalar::all(255), cv::FILLED, cv::LINE_AA, 4);
      cv::Mat grey;
      cv::cvtColor(warp.distort(picture), grey, cv::COLOR_BGR2GRAY);
      ASSERT_EQ(grey.size(), cv::Size(camera.width, camera.height));
      const cv::Moments m = cv::moments(grey);
      const Eigen::Vector2d expected = project(camera, p)->pixel;
      EXPECT_NEAR(m.m10 / m.m00, expected.x(), 0.08);
      EXPECT_NEAR(m.m01 / m.m00, expected.y(), 0.08);
    }
  }
}

TEST_P(EveryLens, LeavesNoBlackBorder) {
  const LensWarp warp(lens(GetParam().first, GetParam().second), 2);
  const Camera large = resized(warp.pinhole(), 2);
  // A rim of two pixels round the wide picture is black; nothing of it may show.
  cv::Mat picture(large.height, large.width, CV_8UC3, cv::Scalar::all(255));
  cv::rectangle(picture, {0, 0}, {large.width - 1, large.height - 1}, cv::Scalar::all(0), 2);
  double darkest = 0;
  cv::minMaxLoc(warp.distort(picture).reshape(1), &darkest);
  EXPECT_EQ(darkest, 255);
}

INSTANTIATE_TEST_SUITE_P(LensWarp, EveryLens,
                         testing::Values(std::pair{-0.28, 0.08}, std::pair{0.15, 0.02}, std::pair{0.0, 0.0}));

TEST(LensWarp, TakesTheNearestDepth) {
  const Camera camera = lens(-0.2, 0.05);
  const LensWarp warp(camera, 2);
  cv::Mat depth(warp.pinhole().height, warp.pinhole().width, CV_32FC1, cv::Scalar(1.0));
  depth.colRange(depth.cols / 2, depth.cols) = 3.0F;
  const cv::Mat distorted = warp.distort_depth(depth);
  ASSERT_EQ(distorted.size(), cv::Size(camera.width, camera.height));
  cv::Mat between;
  cv::inRange(distorted, 1.01, 2.99, between);
  EXPECT_EQ(cv::countNonZero(between), 0);
  EXPECT_GT(cv::countNonZero(distorted == 3.0F), 10000);
}

TEST(LensWarp, RefusesADistortionWithoutInverse) {
  EXPECT_THROW(LensWarp(lens(-3.0, 0.0), 1), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
