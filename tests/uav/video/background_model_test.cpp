// SPDX-License-Identifier: Apache-2.0
#include "uav/video/background_model.h"

#include <array>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

cv::Mat grey(int level) {
  return cv::Mat(20, 30, CV_8UC1, cv::Scalar(level));
}

TEST(BackgroundModel, IsTheMeanOfTheFirstFrames) {
  BackgroundModel model;
  for (const int level : {100, 104, 108}) model.learn(model.residual(grey(level)), {});
  EXPECT_NEAR(model.residual(grey(104)).at<float>(5, 5), 0.0, 1e-4);
}

TEST(BackgroundModel, ForgetsOverItsMemory) {
  BackgroundModel model({10.0, 0.1});
  for (int i = 0; i < 30; ++i) model.learn(model.residual(grey(100)), {});
  for (int i = 0; i < 10; ++i) model.learn(model.residual(grey(120)), {});
  EXPECT_NEAR(model.residual(grey(120)).at<float>(5, 5), 20.0 * std::pow(0.9, 10), 1e-3);
}

TEST(BackgroundModel, LearnsObjectsMoreSlowlyAlsoWhereTheirAreasOverlapOrReachOut) {
  BackgroundModel model({10.0, 0.1});
  for (int i = 0; i < 30; ++i) model.learn(model.residual(grey(100)), {});
  const std::array<cv::Rect, 3> objects{cv::Rect(2, 2, 5, 5), cv::Rect(4, 4, 5, 5), cv::Rect(-3, 15, 8, 20)};
  model.learn(model.residual(grey(120)), objects);
  const cv::Mat residual = model.residual(grey(120));
  EXPECT_NEAR(residual.at<float>(3, 3), 19.8, 1e-3);
  EXPECT_GT(residual.at<float>(5, 5), 19.7);
  EXPECT_NEAR(residual.at<float>(18, 1), 19.8, 1e-3);
  EXPECT_NEAR(residual.at<float>(10, 20), 18.0, 1e-3);
}

TEST(BackgroundModel, RefusesImagesOfAnotherKind) {
  BackgroundModel model;
  model.residual(grey(100));
  EXPECT_THROW(model.residual(cv::Mat::zeros(20, 31, CV_8UC1)), std::invalid_argument);
  EXPECT_THROW(model.residual(cv::Mat::zeros(20, 30, CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(BackgroundModel({0.5, 0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
