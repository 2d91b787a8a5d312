// SPDX-License-Identifier: Apache-2.0
#include "uav/video/image_stabiliser.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "datasets/sky_scene.h"

namespace alidade {
namespace {

SkySceneOptions small_options(double shake_px) {
  SkySceneOptions options;
  options.receivers = 1;
  options.width = 480;
  options.height = 270;
  options.focal_px = 340.0;
  options.least_speed_px_s = 4.0;
  options.duration_s = 2.0;
  options.look.shake_px = shake_px;
  options.look.shake_roll_rad = 1e-3 * shake_px;
  return options;
}

TEST(ImageStabiliser, FollowsTheCamerasSwayAndTurn) {
  SkyVideo video(make_sky_scene(small_options(1.2)), 0);
  ImageStabiliser stabiliser;
  double squares = 0.0, corner_squares = 0.0, greatest_px = 0.0;
  int count = 0;
  Eigen::Isometry2d T_first_steady = Eigen::Isometry2d::Identity();
  while (const auto frame = video.next()) {
    const auto T_image_first = stabiliser.follow(frame->image);
    ASSERT_TRUE(T_image_first) << count;
    const DotSighting &a = frame->sightings.at(0), &b = frame->sightings.at(1);
    // The sway moves two targets; what it makes of the first image's view of them, they both tell.
    const Eigen::Vector2d between = b.steady_pixel - a.steady_pixel, now = b.pixel - a.pixel;
    const double turn = std::atan2(between.x() * now.y() - between.y() * now.x(), between.dot(now));
    Eigen::Isometry2d T_image_steady = Eigen::Isometry2d::Identity();
    T_image_steady.linear() = Eigen::Rotation2Dd(turn).toRotationMatrix();
    T_image_steady.translation() = a.pixel - T_image_steady.linear() * a.steady_pixel;
    if (count == 0) T_first_steady = T_image_steady;
    const Eigen::Isometry2d truth = T_image_steady * T_first_steady.inverse();
    const Eigen::Vector2d middle(240.0, 135.0), corner(0.0, 0.0);
    squares += (*T_image_first * middle - truth * middle).squaredNorm();
    corner_squares += (*T_image_first * corner - truth * corner).squaredNorm();
    greatest_px = std::max(greatest_px, (truth * middle - middle).norm());
    ++count;
  }
  EXPECT_LT(std::sqrt(squares / (2 * count)), 0.05);
  EXPECT_LT(std::sqrt(corner_squares / (2 * count)), 0.1);  // the turn alone moves it by 0.3 px
  EXPECT_GT(greatest_px, 2.0);
}

TEST(ImageStabiliser, KnowsTheMeanViewAsWellAsItSays) {
  double nees = 0.0;
  constexpr int kSeeds = 4;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SkySceneOptions options = small_options(1.2);
    options.look.seed = seed;
    options.look.shake_roll_rad = 0.0;
    options.duration_s = 1.2;
    SkyVideo video(make_sky_scene(options), 0);
    ImageStabiliser stabiliser;
    std::optional<Eigen::Vector2d> first_sway;
    while (const auto frame = video.next()) {
      stabiliser.follow(frame->image);
      if (!first_sway) first_sway = frame->sightings.at(0).pixel - frame->sightings.at(0).steady_pixel;
    }
    // A pixel of the first image is where a steady camera would show it, moved by the first sway.
    const Eigen::Vector2d steady(240.0, 135.0);
    const Eigen::Vector2d error = stabiliser.mean_pixel(steady + *first_sway) - steady;
    nees += 0.5 * error.dot(stabiliser.mean_covariance().inverse() * error) / kSeeds;
  }
  EXPECT_GT(nees, 0.05);  // a rough statement, on the safe side
  EXPECT_LT(nees, 2.2);   // 8 degrees of freedom: 2.19 at 97.5 %
}

TEST(ImageStabiliser, TakesATripodForWhatItIs) {
  SkyVideo video(make_sky_scene(small_options(0.0)), 0);
  ImageStabiliser stabiliser;
  for (int i = 0; i < 10; ++i) {
    const auto T_image_first = stabiliser.follow(video.next()->image);
    ASSERT_TRUE(T_image_first);
    EXPECT_LT(T_image_first->translation().norm(), 0.1);
  }
}

TEST(ImageStabiliser, IsEmptyBeforeCloudsAlone) {
  SkyVideo video(make_sky_scene(small_options(0.0)), 0);
  ImageStabiliser stabiliser;
  const cv::Rect sky(0, 0, 480, 120);
  EXPECT_TRUE(stabiliser.follow(video.next()->image(sky).clone()));  // the first is where it is
  EXPECT_FALSE(stabiliser.follow(video.next()->image(sky).clone()));
}

TEST(ImageStabiliser, NamesWhatIsImpossible) {
  StabiliserOptions options;
  options.inlier_px = 0.0;
  EXPECT_THROW(ImageStabiliser{options}, std::invalid_argument);
}

}  // namespace
}  // namespace alidade
