// SPDX-License-Identifier: Apache-2.0
#include "datasets/rendered_sky.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "camera/rolling_shutter.h"
#include "datasets/sky_scene.h"
#include "evaluation/statistics.h"

namespace alidade {
namespace {

SkySceneOptions small_options() {
  SkySceneOptions options;
  options.receivers = 2;
  options.width = 320;
  options.height = 180;
  options.focal_px = 225.0;
  options.least_speed_px_s = 3.0;
  options.duration_s = 0.4;
  return options;
}

TEST(SkyVideo, TellsWhereTargetsAreWhenTheirOwnRowsAreExposed) {
  SkySceneOptions options = small_options();
  options.readout_s = 0.03;
  SkyScene scene = make_sky_scene(options);
  scene.receivers[1].clock = {0.25, 1e-4, Timestamp{}, Eigen::Matrix2d::Zero()};
  SkyVideo video(scene, 1);
  int frames = 0;
  while (const auto frame = video.next()) {
    ++frames;
    ASSERT_EQ(frame->sightings.size(), scene.paths.size());
    for (const DotSighting& dot : frame->sightings) {
      const auto bearing = bearing_of(scene.receivers[1], {frame->time, 1, dot.pixel});
      const Eigen::Vector3d to =
          position_at(scene.paths[static_cast<std::size_t>(dot.target)], bearing->time) - bearing->origin_world;
      EXPECT_LT((to.normalized() - bearing->direction_world).norm(), 1e-6);  // 0.0002 px
    }
  }
  EXPECT_EQ(frames, 12);  // 0.4 s at 29.7 Hz
}

TEST(SkyVideo, DrawsDotsAsBrightOverTheNoiseAsTheirSnrSays) {
  SkySceneOptions options = small_options();
  options.receivers = 1;
  options.dots = {{6.0, 12.0, true}, {6.0, 20.0, false}};
  options.look.shake_px = 2.5;  // they sway with the picture
  SkyScene scene = make_sky_scene(options), bare = scene;
  bare.paths.clear();
  bare.dots.clear();
  SkyVideo video(scene, 0), empty(bare, 0);
  std::vector<double> dark, bright;
  while (const auto frame = video.next()) {
    const auto background = empty.next();  // the noise is the same, but for its share of the dot's own light
    for (const DotSighting& dot : frame->sightings) {
      const cv::Point middle(static_cast<int>(std::lround(dot.pixel.x())),
                             static_cast<int>(std::lround(dot.pixel.y())));
      const double grey = background->image.at<unsigned char>(middle);
      const double noise = std::sqrt(1.0 + 0.02 * grey + 1.0 / 12.0);
      const double height = frame->image.at<unsigned char>(middle) - grey;
      (dot.target == 0 ? dark : bright).push_back(height / noise);
    }
  }
  EXPECT_NEAR(summarise(dark).mean, -12.0, 1.0);
  EXPECT_NEAR(summarise(bright).mean, 20.0, 1.5);
}

TEST(SkyVideo, NoiseGrowsWithBrightnessAsToldByItsOptions) {
  SkySceneOptions options = small_options();
  options.receivers = 1;
  options.dots.clear();
  options.duration_s = 2.0;
  options.look.backdrop.cloud_cover = 0.0;
  options.look.backdrop.wind_rad_s = 0.0;
  options.look.shot_noise = 0.05;
  const SkyScene scene = make_sky_scene(options);
  SkyVideo video(scene, 0);
  std::vector<double> sky;
  while (const auto frame = video.next()) sky.push_back(frame->image.at<unsigned char>(20, 160));
  const Statistics s = summarise(sky);
  const double variance = 1.0 + 0.05 * s.mean + 1.0 / 12.0;
  EXPECT_NEAR(s.std * s.std / variance, 1.0, 0.55);  // 60 frames: a standard error of 0.18
}

TEST(SkyVideo, SwaysThePictureWithItsTargets) {
  SkySceneOptions options = small_options();
  options.receivers = 1;
  options.duration_s = 4.0;
  options.look.shake_px = 1.5;
  options.look.shake_roll_rad = 1e-3;
  const SkyScene scene = make_sky_scene(options);
  SkyVideo video(scene, 0);
  std::vector<double> shifts;
  double squares = 0.0;
  cv::Mat first, ground;
  Eigen::Vector2d sway_first = Eigen::Vector2d::Zero();
  while (const auto frame = video.next()) {
    if (frame->sightings.empty()) continue;
    const Eigen::Vector2d sway = frame->sightings[0].pixel - frame->sightings[0].steady_pixel;
    shifts.push_back(sway.x());
    frame->image(cv::Rect(0, 140, 320, 40)).convertTo(ground, CV_32FC1);
    if (first.empty()) {
      first = ground.clone();
      sway_first = sway;
    }
    const cv::Point2d moved = cv::phaseCorrelate(first, ground);
    squares += (Eigen::Vector2d(moved.x, moved.y) - (sway - sway_first)).squaredNorm();
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(2 * shifts.size())), 0.35);  // what phase correlation can tell
  EXPECT_NEAR(summarise(shifts).rmse, 1.5, 0.5);
}

TEST(SkyVideo, GivesTheSameBytesAgain) {
  const SkyScene scene = make_sky_scene(small_options());
  SkyVideo a(scene, 0), b(scene, 0);
  a.next();
  b.next();
  EXPECT_EQ(cv::norm(a.next()->image, b.next()->image, cv::NORM_INF), 0.0);
}

TEST(SkyVideo, NamesWhatIsImpossible) {
  SkyScene scene = make_sky_scene(small_options());
  scene.dots.pop_back();
  EXPECT_THROW(SkyVideo(scene, 0), std::invalid_argument);
  scene = make_sky_scene(small_options());
  scene.receivers[0].camera.reset();
  EXPECT_THROW(SkyVideo(scene, 0), std::invalid_argument);
  SkyLook look;
  look.shake_px = -1.0;
  EXPECT_THROW(validate(look), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
