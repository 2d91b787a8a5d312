// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/bundle_priors.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

const BoardShape kShape = shape_of(test::simulated_board());

BoardBundle bundle_of(const Camera& camera) {
  return {{{camera, Eigen::Isometry3d::Identity()}}, {}, {0.001, -0.002}};
}

TEST(BundlePriors, HoldDistortionAndWarpAlone) {
  const Camera camera = test::simulated_camera(LensModel::Rational);
  BundleFreedom freedom;
  freedom.intrinsics = {free_intrinsics(LensModel::Rational)};
  const auto priors = bundle_priors(bundle_of(camera), kShape, freedom);
  ASSERT_EQ(priors.size(), 10U);
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(priors[static_cast<std::size_t>(i)].place, 4 + i);
    EXPECT_EQ(priors[static_cast<std::size_t>(i)].value, coefficients(camera.distortion)[i]);
  }
  EXPECT_EQ(priors[8].place, 12);
  EXPECT_EQ(priors[8].value, 0.001);
  EXPECT_EQ(priors[9].value, -0.002);
  const double sigma_m = 0.005 * kShape.extent_m;
  EXPECT_NEAR(priors[9].information, 1 / (sigma_m * sigma_m), 1e-6 / (sigma_m * sigma_m));
}

// One standard deviation of k1 alone moves the image's corner by its distance from the centre: x_d = x (1 + k1 r²) =
// 2x.
TEST(BundlePriors, LetACoefficientMoveTheCornerByItsDistance) {
  for (const LensModel lens : {LensModel::Rational, LensModel::Fisheye}) {
    Camera camera = start_camera(lens, 640, 480, 400);  // the image's corner lies at r = 1 ...
    camera.fx = camera.fy = 500;                        // ... and now at 0.8
    BundleFreedom freedom;
    freedom.intrinsics = {free_intrinsics(lens)};
    freedom.warp = false;
    for (const BundlePrior& prior : bundle_priors(bundle_of(camera), kShape, freedom)) {
      Intrinsics values = intrinsics(camera);
      values[prior.place] += 1 / std::sqrt(prior.information);
      const auto moved = with_intrinsics(camera, values).distortion;
      // A radius of 0.8 in the plane of the model's own radius: tan θ or θ.
      const double z = lens == LensModel::Fisheye ? 0.8 / std::tan(0.8) : 1.0;
      const Eigen::Vector2d before = distort(camera.distortion, {0.64, 0.48, z}).xy;
      const double move = (distort(moved, {0.64, 0.48, z}).xy - before).norm();
      const double share = move / before.norm();
      const bool is_denominator = lens == LensModel::Rational && prior.place >= 9;  // x / (1 + 1)
      const bool is_tangential = lens == LensModel::Rational && (prior.place == 6 || prior.place == 7);
      if (is_tangential) {
        EXPECT_GT(share, 1.0) << prior.place;  // r² + 2y² of r²: between one and three times
        EXPECT_LT(share, 3.0) << prior.place;
      } else {
        EXPECT_NEAR(share, is_denominator ? 0.5 : 1.0, 1e-9) << name_of(lens) << " " << prior.place;
      }
    }
  }
}

TEST(BundlePriors, SayNothingOfWhatStands) {
  BundleFreedom freedom;
  freedom.warp = false;
  EXPECT_TRUE(bundle_priors(bundle_of(test::simulated_camera(LensModel::Brown)), kShape, freedom).empty());
  freedom.intrinsics = {{0, 1, 4}};
  const auto priors = bundle_priors(bundle_of(test::simulated_camera(LensModel::Brown)), kShape, freedom);
  ASSERT_EQ(priors.size(), 1U);
  EXPECT_EQ(priors[0].place, 2);
}

}  // namespace
}  // namespace alidade
