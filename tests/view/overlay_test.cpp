// SPDX-License-Identifier: Apache-2.0
#include "view/overlay.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace alidade {
namespace {

cv::Mat changed(const cv::Mat& picture, int background) {
  cv::Mat mask;
  cv::inRange(picture, cv::Scalar::all(background), cv::Scalar::all(background), mask);
  return ~mask;
}

TEST(DrawOverlay, MarksEachStateInItsOwnColour) {
  const cv::Mat frame(60, 80, CV_8UC1, cv::Scalar(100));
  std::vector<cv::Vec3d> colours;
  for (auto state : {TrackState::Tracked, TrackState::Predicted, TrackState::Rejected, TrackState::New}) {
    const cv::Mat picture = draw_overlay(frame, {{{{40, 30}, {}, state, {}}}, ""});
    ASSERT_EQ(picture.type(), CV_8UC3);
    const cv::Mat mask = changed(picture, 100);
    EXPECT_GT(cv::countNonZero(mask), 3);
    const cv::Scalar mean = cv::mean(picture, mask);
    colours.emplace_back(mean[0], mean[1], mean[2]);
  }
  for (std::size_t a = 0; a < colours.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) EXPECT_GT(cv::norm(colours[a] - colours[b]), 30) << a << " " << b;
  }
}

TEST(DrawOverlay, EllipseReachesThreeSigma) {
  OverlayTrack track;
  track.pixel = {-100, -100};  // outside: only the ellipse shows
  track.predicted = PredictedPixel{{100, 60}, Eigen::Vector2d(100, 9).asDiagonal()};
  const cv::Mat mask = changed(draw_overlay(cv::Mat(120, 200, CV_8UC1, cv::Scalar(0)), {{track}, ""}), 0);
  std::vector<cv::Point> at;
  cv::findNonZero(mask, at);
  ASSERT_FALSE(at.empty());
  int left = 999, right = 0, top = 999, bottom = 0;
  for (const auto& p : at) {
    left = std::min(left, p.x), right = std::max(right, p.x);
    top = std::min(top, p.y), bottom = std::max(bottom, p.y);
  }
  EXPECT_NEAR(left, 100 - 30, 2);
  EXPECT_NEAR(right, 100 + 30, 2);
  EXPECT_NEAR(top, 60 - 9, 2);
  EXPECT_NEAR(bottom, 60 + 9, 2);
}

TEST(DrawOverlay, TailLeadsToThePoint) {
  const cv::Mat frame(60, 80, CV_8UC3, cv::Scalar::all(0));
  const cv::Mat picture = draw_overlay(frame, {{{{60, 30}, {{10, 30}, {30, 30}}, TrackState::Tracked, {}}}, ""});
  for (int x : {10, 20, 30, 45, 60}) EXPECT_GT(picture.at<cv::Vec3b>(30, x)[1], 80) << x;
  EXPECT_EQ(picture.at<cv::Vec3b>(30, 5)[1], 0);
}

TEST(DrawOverlay, LeavesOutWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  OverlayTrack track;
  track.pixel = {nan, 3};
  track.tail = {{1, 1}, {nan, nan}};
  track.predicted = PredictedPixel{{10, 10}, Eigen::Matrix2d::Constant(nan)};
  const cv::Mat frame(60, 80, CV_8UC3, cv::Scalar::all(50));
  EXPECT_EQ(cv::norm(draw_overlay(frame, {{track}, ""}), frame, cv::NORM_INF), 0);
}

TEST(DrawOverlay, WritesTheStatusAtTheBottomOnly) {
  const cv::Mat frame(480, 640, CV_8UC3, cv::Scalar::all(200));
  const cv::Mat picture = draw_overlay(frame, {{}, "frame 3: tracked"});
  EXPECT_EQ(cv::norm(picture.rowRange(0, 440), frame.rowRange(0, 440), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(picture.row(470), frame.row(470), cv::NORM_INF), 50);
}

TEST(DrawOverlay, NeverWritesToTheFrame) {
  const cv::Mat frame(60, 80, CV_8UC3, cv::Scalar::all(7));
  const cv::Mat before = frame.clone();
  draw_overlay(frame, {{{{40, 30}, {}, TrackState::New, {}}}, "status"});
  EXPECT_EQ(cv::norm(frame, before, cv::NORM_INF), 0);
}

TEST(DrawOverlay, RefusesOtherImages) {
  EXPECT_THROW(draw_overlay(cv::Mat(), {}), std::invalid_argument);
  EXPECT_THROW(draw_overlay(cv::Mat(5, 5, CV_16UC1), {}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
