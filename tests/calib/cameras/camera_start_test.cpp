// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/camera_start.h"

#include <gtest/gtest.h>

#include "calib/bundle/bundle_fit.h"
#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

constexpr ImageExtent kImage{640, 480};

TEST(StartCameraBundle, IsNearTheTruthForEveryLens) {
  for (const LensModel lens : {LensModel::Radial, LensModel::Brown, LensModel::Rational, LensModel::Fisheye}) {
    const auto simulated = test::simulate_bundle(test::simulated_camera(lens), {.noise_px = 0.2}, 2);
    const auto start = start_camera_bundle(lens, kImage, simulated.shape, simulated.views);
    ASSERT_TRUE(start) << name_of(lens);
    const Camera& camera = start->bundle.cameras[0].camera;
    EXPECT_NEAR(camera.fx, simulated.truth.cameras[0].camera.fx, 0.1 * camera.fx) << name_of(lens);
    ASSERT_EQ(start->bundle.T_rig_board.size(), simulated.views.size());
    EXPECT_LT(rms_px(start->bundle, simulated.shape, start->views), 10) << name_of(lens);
  }
}

// From a long lens (2.5 image widths) to a wide one (0.45).
TEST(StartCameraBundle, FindsLongAndShortLenses) {
  for (const double focal : {290.0, 400.0, 900.0, 1600.0}) {
    const auto simulated = test::simulate_bundle(start_camera(LensModel::Radial, 640, 480, focal), {}, 3);
    const auto start = start_camera_bundle(LensModel::Radial, kImage, simulated.shape, simulated.views);
    ASSERT_TRUE(start) << focal;
    EXPECT_NEAR(start->bundle.cameras[0].camera.fx, focal, 0.02 * focal);
  }
}

TEST(StartCameraBundle, GivesAViewWithoutAPoseNoWeight) {
  auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Radial), {}, 2);
  simulated.views[3].corners.resize(5);
  simulated.views[3].weights.resize(5);
  const auto start = start_camera_bundle(LensModel::Radial, kImage, simulated.shape, simulated.views);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->views[3].weights, std::vector<double>(5, 0.0));
  EXPECT_EQ(start->views[4].weights, std::vector<double>(54, 1.0));
}

TEST(StartCameraBundle, IsEmptyWithoutTwoBoards) {
  auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.views = 3}, 2);
  EXPECT_FALSE(start_camera_bundle(LensModel::Radial, kImage, simulated.shape, {}));
  for (const std::size_t v : {0U, 2U}) {
    simulated.views[v].corners.resize(9);  // the first row alone
    simulated.views[v].weights.resize(9);
  }
  EXPECT_FALSE(start_camera_bundle(LensModel::Radial, kImage, simulated.shape, simulated.views));
}

}  // namespace
}  // namespace alidade
