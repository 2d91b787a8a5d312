// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_picture.h"

#include <cmath>

#include <gtest/gtest.h>

namespace alidade {
namespace {

ReceiverCalibrationRun run_of_two() {
  ReceiverCalibrationRun run;
  run.sources.truth = "path.csv";
  run.receivers.resize(2);
  for (int k = 0; k < 2; ++k) {
    CalibratedReceiver& one = run.receivers[static_cast<std::size_t>(k)];
    one.given.id = k;
    one.given.camera = Camera{640, 480, 500, 500, 319.5, 239.5, {}, 0.0};
    one.found = one.given;
    one.found.T_world_receiver.translation().x() = 1.0;
  }
  run.receivers[1].left_why = "it saw nothing";
  run.receivers[1].found = run.receivers[1].given;
  for (const double t_s : {0.0, 0.2, 0.4, 9.0, 9.2}) run.path.push_back({Timestamp(from_seconds(t_s)), {t_s, 5, 5}});
  run.receivers[0].after.median_px = 1.0;
  for (int i = 0; i < 30; ++i) {
    run.receivers[0].after.samples.push_back({0.1 * i, {100.0, 300.0}, {i == 7 ? 50.0 : 1.0, 0.0}});
  }
  return run;
}

TEST(ReceiverCalibrationPicture, ShowsCalibratedReceiversTwiceAndOthersOnce) {
  const Scene scene = scene_of(run_of_two());
  EXPECT_EQ(scene.cameras.size(), 3u);
  EXPECT_EQ(scene.cameras[0].colour, palette::kReference);
  EXPECT_EQ(scene.labels.size(), 2u);
  EXPECT_EQ(scene.legend.size(), 3u);
}

TEST(ReceiverCalibrationPicture, BreaksThePathWhereItWasNotSeen) {
  const Scene scene = scene_of(run_of_two());
  ASSERT_EQ(scene.paths.size(), 1u);
  ASSERT_EQ(scene.paths[0].points_world.size(), 6u);
  EXPECT_TRUE(std::isnan(scene.paths[0].points_world[3].x()));
  EXPECT_EQ(scene.paths[0].colour, palette::kTruth);
}

TEST(ReceiverCalibrationPicture, LeavesFarResidualsOffThePlotAndCountsThem) {
  const Plot plot = residuals_over_time(run_of_two().receivers[0]);
  ASSERT_EQ(plot.series.size(), 2u);
  EXPECT_EQ(plot.series[0].x.size(), 29u);
  EXPECT_EQ(plot.title, "Residuals of receiver 0 over time (1 of 30 beyond 8.0 px are left off)");
}

TEST(ReceiverCalibrationPicture, DrawsTheMeanOfACellAsAnArrow) {
  const cv::Mat picture = draw_residuals(run_of_two().receivers[0]);
  EXPECT_EQ(picture.cols, 721);
  EXPECT_EQ(picture.rows, 720 * 480 / 640 + 28 + 1);
  // The residual of 1 px, 10 times and twice enlarged, goes right from (100, 300); 720 px show 640.
  const double scale = 720.0 / 640.0;
  const cv::Vec3b on = picture.at<cv::Vec3b>(static_cast<int>(300.5 * scale + 28), static_cast<int>(112.0 * scale));
  EXPECT_EQ(on, cv::Vec3b(palette::kEstimate[2], palette::kEstimate[1], palette::kEstimate[0]));
  const cv::Vec3b left = picture.at<cv::Vec3b>(static_cast<int>(300.5 * scale + 28), static_cast<int>(90.0 * scale));
  EXPECT_EQ(left, cv::Vec3b(255, 255, 255));
}

}  // namespace
}  // namespace alidade
