// SPDX-License-Identifier: Apache-2.0
#include "datasets/drawn_dot.h"

#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

Eigen::Vector2d centroid(const cv::Mat& picture) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0.0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      sum += picture.at<float>(y, x) * Eigen::Vector2d(x, y);
      weight += picture.at<float>(y, x);
    }
  }
  return sum / weight;
}

// Of the pixel about (x, y), by many points.
double share_within(const Eigen::Vector2d& centre, double radius, int x, int y) {
  constexpr int kSide = 200;
  int inside = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Eigen::Vector2d point(x - 0.5 + (i % kSide + 0.5) / kSide, y - 0.5 + (i / kSide + 0.5) / kSide);
    inside += (point - centre).norm() < radius;
  }
  return static_cast<double>(inside) / (kSide * kSide);
}

TEST(DrawnDot, CoversEachPixelByTheDiscsShareOfIt) {
  for (const double size : {1.0, 2.3, 5.0}) {
    const Eigen::Vector2d pixel(6.37, 5.81);
    cv::Mat picture = cv::Mat::zeros(13, 13, CV_32FC1);
    draw_dot(picture, {pixel, size, 1.0});
    for (int y = 0; y < 13; ++y) {
      for (int x = 0; x < 13; ++x) {
        EXPECT_NEAR(picture.at<float>(y, x), share_within(pixel, 0.5 * size, x, y), 0.01) << size << " px";
      }
    }
  }
}

TEST(DrawnDot, KeepsItsAreaAndPlaceWhenBlurred) {
  for (const double size : {2.0, 3.3, 6.0}) {
    for (int i = 0; i < 7; ++i) {
      const Eigen::Vector2d pixel(15.0 + i / 7.0, 14.5 - i / 9.0);
      cv::Mat picture = cv::Mat::zeros(31, 33, CV_32FC1);
      draw_dot(picture, {pixel, size, -20.0}, 0.6);
      const double area = std::numbers::pi * size * size / 4.0;
      EXPECT_NEAR(cv::sum(picture)[0], -20.0 * area, 0.01 * 20.0 * area) << size << " px at " << pixel.transpose();
      EXPECT_LT((centroid(picture) - pixel).norm(), 0.04) << size << " px at " << pixel.transpose();
    }
  }
}

TEST(DrawnDot, IsCutOffAtTheBorderAndAddsToWhatIsThere) {
  cv::Mat picture(8, 8, CV_32FC1, cv::Scalar(100.0));
  draw_dot(picture, {{0.0, 4.0}, 5.0, 10.0});
  draw_dot(picture, {{-30.0, 4.0}, 5.0, 10.0});
  EXPECT_FLOAT_EQ(picture.at<float>(4, 0), 110.0f);
  EXPECT_FLOAT_EQ(picture.at<float>(4, 7), 100.0f);
}

TEST(DrawnDot, NeedsFloatsAndASize) {
  cv::Mat bytes = cv::Mat::zeros(8, 8, CV_8UC1), picture = cv::Mat::zeros(8, 8, CV_32FC1);
  EXPECT_THROW(draw_dot(bytes, {}), std::invalid_argument);
  EXPECT_THROW(draw_dot(picture, {{4.0, 4.0}, 0.0, 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
