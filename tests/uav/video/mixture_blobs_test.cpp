// SPDX-License-Identifier: Apache-2.0
#include "uav/video/mixture_blobs.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

TEST(MixtureBlobs, AreTheCentresOfWhatIsNew) {
  MixtureBlobDetector detector;
  const cv::Mat empty(60, 80, CV_8UC1, cv::Scalar(120));
  for (int i = 0; i < 30; ++i) detector.detect(empty);
  cv::Mat image = empty.clone();
  image(cv::Rect(20, 30, 3, 5)).setTo(180);
  image.at<unsigned char>(5, 5) = 180;  // a single pixel is left out
  image(cv::Rect(40, 10, 20, 20)).setTo(180);
  const auto blobs = detector.detect(image);
  ASSERT_EQ(blobs.size(), 1U);
  EXPECT_LT((blobs[0] - Eigen::Vector2d(21.0, 32.0)).norm(), 1e-6);
}

TEST(MixtureBlobs, NameWhatIsImpossible) {
  EXPECT_THROW(MixtureBlobDetector({0, 16.0, 2, 150}), std::invalid_argument);
  EXPECT_THROW(MixtureBlobDetector({100, 0.0, 2, 150}), std::invalid_argument);
  EXPECT_THROW(MixtureBlobDetector({100, 16.0, 9, 8}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
