// SPDX-License-Identifier: Apache-2.0
#include "capture/undistortion.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <Eigen/SVD>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace alidade {
namespace {

const Camera kBarrel{160, 120, 100, 101, 80, 58, BrownConrady{-0.3, 0.1, 0.001, -0.002}};
const Camera kPincushion{160, 120, 100, 101, 80, 58, BrownConrady{0.3, 0.05}};
const Camera kMoustache{160, 120, 100, 101, 80, 58, BrownConrady{-0.25, 0.35}};
const Camera kFolding{160, 120, 100, 101, 80, 58, BrownConrady{-0.22}};  // its corners have no rays
const Camera kRational{160, 120, 100, 101, 80, 58, BrownConrady{0.3, 0.05, 0, 0, 0.001, 0.5, -0.01, 0.002}};
const Camera kFisheye{160, 120, 75, 75, 79.5, 59.5, Fisheye{-0.01, 0.002}};
const Camera kWideFisheye{160, 120, 45, 45, 79.5, 59.5, Fisheye{}};  // 100° off axis at the sides

int count_unseen(const Camera& camera, const Camera& pinhole) {
  return camera.width * camera.height - cv::countNonZero(undistortion_map(camera, pinhole).is_seen);
}

TEST(UndistortedCamera, OfAlphaZeroShowsNothingThatTheLensDidNotSee) {
  for (const Camera& camera : {kBarrel, kPincushion, kMoustache, kFolding, kRational, kFisheye, kWideFisheye}) {
    const auto pinhole = undistorted_camera(camera);
    ASSERT_TRUE(pinhole);
    EXPECT_FALSE(find_fault(*pinhole));
    EXPECT_TRUE(is_pinhole(pinhole->distortion));
    EXPECT_EQ(count_unseen(camera, *pinhole), 0);
  }
}

TEST(UndistortedCamera, OfAlphaOneShowsAllThatTheLensSaw) {
  for (const Camera& camera : {kBarrel, kPincushion, kMoustache, kRational, kFisheye}) {
    const auto pinhole = undistorted_camera(camera, {.alpha = 1});
    ASSERT_TRUE(pinhole) << intrinsics(camera).transpose();
    for (const double x : {0.0, 40.0, 159.0}) {
      for (const double y : {0.0, 60.0, 119.0}) {
        const auto ray = unproject(camera, {x, y});
        ASSERT_TRUE(ray);
        const auto shown = project(*pinhole, *ray);
        ASSERT_TRUE(shown);
        EXPECT_TRUE(is_inside(*pinhole, shown->pixel, -1e-6)) << x << " " << y << ": " << shown->pixel.transpose();
      }
    }
    EXPECT_GT(count_unseen(camera, *pinhole), 0);
  }
}

TEST(UndistortedCamera, ShowsMoreWithMoreAlpha) {
  double last = 0;
  for (const double alpha : {0.0, 0.25, 0.5, 1.0}) {
    const auto pinhole = undistorted_camera(kBarrel, {.alpha = alpha});
    ASSERT_TRUE(pinhole);
    const double field = 1.0 / (pinhole->fx * pinhole->fy);
    EXPECT_GT(field, last);
    last = field;
  }
}

TEST(UndistortedCamera, IsOpenCvs) {
  // cv2.getOptimalNewCameraMatrix(K, k, (159, 119), alpha, (160, 120)) of OpenCV 4.6, which looks for the last pixels'
  // centres at the width and height that it is given.
  const Camera camera{160, 120, 100, 101, 80, 58, BrownConrady{-0.1, 0.02, 0.001, -0.002}};
  const double expected[][5] = {{0, 93.857368, 97.526054, 79.578018, 58.015356},
                                {0.5, 92.398041, 94.516468, 79.509172, 58.077830},
                                {1, 90.938713, 91.506882, 79.440326, 58.140303}};
  for (const auto& [alpha, fx, fy, cx, cy] : expected) {
    const auto pinhole = undistorted_camera(camera, {.alpha = alpha});
    ASSERT_TRUE(pinhole);
    EXPECT_NEAR(pinhole->fx, fx, 0.01);  // it looks at 9 pixels a side, we at 65
    EXPECT_NEAR(pinhole->fy, fy, 0.01);
    EXPECT_NEAR(pinhole->cx, cx, 0.01);
    EXPECT_NEAR(pinhole->cy, cy, 0.01);
  }
}

TEST(UndistortedCamera, IsEmptyWhereTheLensSeesTooWideForAll) {
  EXPECT_FALSE(undistorted_camera(kWideFisheye, {.alpha = 1}));
  EXPECT_FALSE(undistorted_camera(kFolding, {.alpha = 1}));
  EXPECT_TRUE(undistorted_camera(kWideFisheye, {.alpha = 1, .focal_px = 30}));
}

TEST(UndistortedCamera, KeepsTheReadoutAndTheSize) {
  Camera rolling = kBarrel;
  rolling.readout_s = 0.02;
  const auto pinhole = undistorted_camera(rolling);
  ASSERT_TRUE(pinhole);
  EXPECT_EQ(pinhole->readout_s, 0.02);
  EXPECT_EQ(pinhole->width, 160);
  EXPECT_EQ(pinhole->height, 120);
}

TEST(UndistortedCamera, OfAGivenFocalLengthLooksAlongTheAxis) {
  const auto pinhole = undistorted_camera(kFisheye, {.alpha = 0, .focal_px = 50});
  EXPECT_EQ(pinhole, (Camera{160, 120, 50, 50, 79.5, 59.5, {}}));
}

TEST(UndistortedCamera, OfAPinholeIsTheSame) {
  const Camera camera{160, 120, 100, 101, 80, 58, {}};
  EXPECT_EQ(undistorted_camera(camera, {.alpha = 1}), camera);
}

TEST(UndistortedCamera, RefusesOptionsThatMeanNothing) {
  EXPECT_THROW(undistorted_camera(kBarrel, {.alpha = 1.1}), std::invalid_argument);
  EXPECT_THROW(undistorted_camera(kBarrel, {.alpha = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(undistorted_camera(kBarrel, {.alpha = 0, .focal_px = -1}), std::invalid_argument);
  EXPECT_THROW(undistorted_camera({}), std::invalid_argument);
}

// An image in which the camera sees a straight edge a x + b y = c (z = 1): bright on one side, blurred by half a pixel.
cv::Mat draw_edge(const Camera& camera, const Eigen::Vector3d& edge) {
  cv::Mat image = cv::Mat::zeros(camera.height, camera.width, CV_8U);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const auto ray = unproject(camera, {x, y});
      if (!ray || !(ray->z() > 0)) continue;
      const double distance_px = edge.dot(*ray) / ray->z() * camera.fx;
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * std::tanh(distance_px)));
    }
  }
  return image;
}

// Root mean square distance, px, of the places where rows cross grey 127.5 from the line through them.
double crookedness(const cv::Mat& image) {
  std::vector<Eigen::Vector2d> crossings;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x + 1 < image.cols; ++x) {
      const double a = image.at<std::uint8_t>(y, x) - 127.5, b = image.at<std::uint8_t>(y, x + 1) - 127.5;
      if (a * b < 0) crossings.emplace_back(x + a / (a - b), y);
    }
  }
  Eigen::MatrixXd points(crossings.size(), 2);
  for (std::size_t i = 0; i < crossings.size(); ++i)
    points.row(static_cast<Eigen::Index>(i)) = crossings[i].transpose();
  points.rowwise() -= points.colwise().mean().eval();
  const Eigen::Vector2d spread = Eigen::JacobiSVD<Eigen::MatrixXd>(points).singularValues();
  return spread[1] / std::sqrt(static_cast<double>(crossings.size()));
}

TEST(UndistortedImage, HasStraightLinesWhereTheWorldHasThem) {
  const Eigen::Vector3d edge(1, 0.1, 0.45);  // near the left side
  for (const Camera& camera : {kBarrel, kPincushion, kRational, kFisheye}) {
    const cv::Mat bent = draw_edge(camera, edge);
    const auto pinhole = undistorted_camera(camera);
    ASSERT_TRUE(pinhole);
    const cv::Mat straight = undistorted_image(bent, undistortion_map(camera, *pinhole));
    EXPECT_GT(crookedness(bent), 0.5);
    EXPECT_LT(crookedness(straight), 0.05);
  }
}

TEST(UndistortedImage, IsTheImageWhereThereIsNoDistortion) {
  const Camera camera{160, 120, 100, 101, 80, 58, {}};
  cv::Mat image(120, 160, CV_8UC3);
  cv::randu(image, 0, 256);
  const cv::Mat same = undistorted_image(image, undistortion_map(camera, camera));
  EXPECT_EQ(cv::norm(same, image, cv::NORM_INF), 0);
}

TEST(UndistortedImage, IsBlackOnlyWhereTheLensSawNothing) {
  const cv::Mat white(120, 160, CV_8U, cv::Scalar(255));
  const auto pinhole = undistorted_camera(kBarrel, {.alpha = 1});
  ASSERT_TRUE(pinhole);
  const UndistortionMap map = undistortion_map(kBarrel, *pinhole);
  EXPECT_EQ(cv::norm(undistorted_image(white, map), map.is_seen, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace alidade
