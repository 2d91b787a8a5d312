// SPDX-License-Identifier: Apache-2.0
#include "datasets/sky_backdrop.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "datasets/sky_scene.h"

namespace alidade {
namespace {

Receiver small_receiver() {
  SkySceneOptions options;
  options.receivers = 1;
  options.width = 320;
  options.height = 180;
  options.focal_px = 225.0;
  options.dots.clear();
  return make_sky_scene(options).receivers.front();
}

Timestamp at(double seconds) {
  return Timestamp(from_seconds(seconds));
}

TEST(SkyBackdrop, HasGroundBelowAndDriftingCloudsAbove) {
  const Receiver receiver = small_receiver();
  const SkyBackdrop backdrop(*receiver.camera, receiver.T_world_receiver, 0);
  const cv::Mat now = backdrop.picture(at(0.0)), later = backdrop.picture(at(5.0));
  const cv::Rect sky(0, 0, 320, 80), ground(0, 150, 320, 30);
  EXPECT_GT(cv::mean(now(sky))[0], cv::mean(now(ground))[0] + 30.0);
  EXPECT_EQ(cv::norm(now(ground), later(ground), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(now(sky), later(sky), cv::NORM_L1) / sky.area(), 1.0);
  EXPECT_EQ(cv::norm(now, SkyBackdrop(*receiver.camera, receiver.T_world_receiver, 0).picture(at(0.0))), 0.0);
}

TEST(SkyBackdrop, ChangesLittleFromFrameToFrame) {
  const Receiver receiver = small_receiver();
  const SkyBackdrop backdrop(*receiver.camera, receiver.T_world_receiver, 0);
  EXPECT_LT(cv::norm(backdrop.picture(at(2.0)), backdrop.picture(at(2.033)), cv::NORM_INF), 4.0);
}

TEST(SkyBackdrop, IsWiderByTheMarginAndTheSameWithin) {
  const Receiver receiver = small_receiver();
  const cv::Mat narrow = SkyBackdrop(*receiver.camera, receiver.T_world_receiver, 0).picture(at(1.0));
  const cv::Mat wide = SkyBackdrop(*receiver.camera, receiver.T_world_receiver, 7).picture(at(1.0));
  ASSERT_EQ(wide.size(), cv::Size(334, 194));
  EXPECT_LT(cv::norm(narrow, wide(cv::Rect(7, 7, 320, 180)), cv::NORM_INF), 1e-3);
}

TEST(SkyBackdrop, NamesWhatIsImpossible) {
  SkyBackdropOptions options;
  options.cloud_cover = 1.5;
  EXPECT_THROW(validate(options), std::invalid_argument);
  EXPECT_THROW(SkyBackdrop({}, Eigen::Isometry3d::Identity(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
