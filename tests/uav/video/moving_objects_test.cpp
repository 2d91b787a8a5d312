// SPDX-License-Identifier: Apache-2.0
#include "uav/video/moving_objects.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "datasets/sky_scene.h"
#include "evaluation/detection_tally.h"

namespace alidade {
namespace {

SkySceneOptions small_options(double shake_px, unsigned seed) {
  SkySceneOptions options;
  options.receivers = 1;
  options.width = 480;
  options.height = 270;
  options.focal_px = 340.0;
  options.least_speed_px_s = 10.0;
  options.duration_s = 2.6;
  options.dots = {{3.0, 6.0, true}, {4.0, 5.0, false}, {6.0, 8.0, true}};
  options.look.shake_px = shake_px;
  options.look.shake_roll_rad = 3e-4 * shake_px;
  options.seed = options.look.seed = options.look.backdrop.seed = seed;
  return options;
}

DetectionTally tally_of(double shake_px, unsigned seeds) {
  DetectionTally tally(1, 3.0, 12.0);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    SkyVideo video(make_sky_scene(small_options(shake_px, seed)), 0);
    MovingObjectDetector detector;
    for (int i = 0; const auto frame = video.next(); ++i) {
      const auto objects = detector.detect(frame->image, frame->time);
      if (i < MovingObjectOptions().warm_up_frames) {
        EXPECT_TRUE(objects.empty());
        continue;
      }
      std::vector<TrueDot> truth;
      std::vector<DetectedDot> dots;
      for (const DotSighting& dot : frame->sightings) truth.push_back({dot.steady_pixel, 0});
      for (const MovingObject& object : objects) dots.push_back({object.pixel, object.covariance});
      tally.add(truth, dots);
    }
  }
  return tally;
}

TEST(MovingObjects, AreFoundBeforeCloudsAndGroundByACameraThatStands) {
  const DetectionTally tally = tally_of(0.0, 1);
  EXPECT_GE(tally.kinds()[0].probability(), 0.95);
  EXPECT_LE(tally.false_per_image(), 0.3);
  EXPECT_LT(tally.kinds()[0].rms_px(), 0.2);
  EXPECT_GT(tally.kinds()[0].nees_per_degree(), 0.7);
  EXPECT_LT(tally.kinds()[0].nees_per_degree(), 1.5);
}

TEST(MovingObjects, AreFoundByACameraThatSways) {
  const DetectionTally tally = tally_of(0.8, 1);
  EXPECT_GE(tally.kinds()[0].probability(), 0.95);
  EXPECT_LE(tally.false_per_image(), 0.3);
  EXPECT_LT(tally.kinds()[0].nees_per_degree(), 2.0);
}

TEST(MovingObjects, TellSizeSnrAndTheFramesOwnPixel) {
  SkyVideo video(make_sky_scene(small_options(0.8, 2)), 0);
  MovingObjectDetector detector;
  double size = 0.0, snr = 0.0, error_px = 0.0;
  int count = 0;
  while (const auto frame = video.next()) {
    for (const MovingObject& object : detector.detect(frame->image, frame->time)) {
      if ((object.frame_pixel - frame->sightings.at(2).pixel).norm() > 3.0) continue;  // 6 px, SNR 8, dark
      size += object.size_px;
      snr += object.snr;
      error_px += (object.frame_pixel - frame->sightings.at(2).pixel).norm();
      ++count;
    }
  }
  ASSERT_GT(count, 40);
  EXPECT_NEAR(size / count, 6.0, 0.8);
  EXPECT_NEAR(snr / count, -9.5, 3.0);  // of the Gaussian's summit, which is above the disc's level
  EXPECT_LT(error_px / count, 0.25);
}

TEST(MovingObjects, AreTheSameInColour) {
  SkyVideo video(make_sky_scene(small_options(0.0, 1)), 0);
  MovingObjectDetector grey, colour;
  for (int i = 0; i < 36; ++i) {
    const auto frame = video.next();
    cv::Mat bgr;
    cv::cvtColor(frame->image, bgr, cv::COLOR_GRAY2BGR);
    EXPECT_EQ(grey.detect(frame->image, frame->time).size(), colour.detect(bgr, frame->time).size());
  }
}

TEST(MovingObjects, BecomeReadingsOfTheirReceiver) {
  MovingObject object;
  object.pixel = {12.5, 40.25};
  object.covariance << 0.04, 0.01, 0.01, 0.09;
  const Timestamp time(from_seconds(1.5));
  const auto readings = readings_of(std::vector<MovingObject>{object}, 3, time);
  ASSERT_EQ(readings.size(), 1U);
  EXPECT_EQ(readings[0].receiver, 3);
  EXPECT_EQ(readings[0].time, time);
  EXPECT_EQ(readings[0].value, object.pixel);
  EXPECT_EQ(readings[0].covariance, object.covariance);
  EXPECT_EQ(readings[0].target, -1);
}

TEST(MovingObjects, RefuseWhatIsNoFrame) {
  MovingObjectDetector detector;
  EXPECT_THROW(detector.detect(cv::Mat::zeros(100, 100, CV_32FC1), Timestamp{}), std::invalid_argument);
  detector.detect(cv::Mat::zeros(100, 100, CV_8UC1), Timestamp{});
  EXPECT_THROW(detector.detect(cv::Mat::zeros(100, 120, CV_8UC1), Timestamp(from_seconds(1.0))), std::invalid_argument);
  MovingObjectOptions options;
  options.warm_up_frames = 0;
  EXPECT_THROW(MovingObjectDetector{options}, std::invalid_argument);
}

}  // namespace
}  // namespace alidade
