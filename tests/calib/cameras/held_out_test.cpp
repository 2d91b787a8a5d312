// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/held_out.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

constexpr ImageExtent kImage{640, 480};

double held_out(LensModel lens, const test::SimulatedBundle& simulated) {
  return held_out_error({lens}, kImage, simulated.shape, simulated.views, {}, 4).value().rms_px;
}

TEST(FitCamera, NeedsNoStart) {
  const auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Fisheye), {.sigma_px = 1e-4}, 7);
  const auto fit = fit_camera({LensModel::Fisheye}, kImage, simulated.shape, simulated.views, {});
  ASSERT_TRUE(fit);
  EXPECT_LT(test::largest_difference_px(simulated.truth.cameras[0].camera, fit->bundle.cameras[0].camera), 1e-6);
  EXPECT_FALSE(fit_camera({LensModel::Fisheye}, kImage, simulated.shape, {}, {}));
}

// Noise of s on each coordinate is s √2 long, a little less after six parameters of each view are fitted to its 108
// coordinates; the lens adds little where it is found from fifteen other views.
TEST(HeldOutRms, IsTheNoiseWhereTheLensIsRight) {
  const auto simulated =
      test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.views = 20, .noise_px = 0.2}, 5);
  const double expected = 0.2 * std::sqrt(2.0 * (1.0 - 6.0 / 108.0));
  EXPECT_NEAR(held_out(LensModel::Radial, simulated), expected, 0.03);
}

TEST(HeldOutRms, TellsTheWrongLens) {
  const auto fisheye = test::simulate_bundle(test::simulated_camera(LensModel::Fisheye), {.noise_px = 0.1}, 5);
  EXPECT_GT(held_out(LensModel::Radial, fisheye), 1.5 * held_out(LensModel::Fisheye, fisheye));
}

TEST(HeldOutRms, CountsAViewWithoutAPlaceAsTenPixels) {
  auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.views = 8}, 5);
  simulated.views[2].corners.resize(5);
  simulated.views[2].weights.resize(5);
  // 5 corners of 10 px and 7 * 54 of none.
  EXPECT_NEAR(held_out(LensModel::Radial, simulated), std::sqrt(500.0 / (5 + 7 * 54)), 1e-3);
}

TEST(HeldOutRms, IsEmptyWhereTooFewAreLeftToFit) {
  const auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.views = 4}, 5);
  EXPECT_TRUE(held_out_error({LensModel::Radial}, kImage, simulated.shape, simulated.views, {}, 4));
  EXPECT_FALSE(held_out_error({LensModel::Radial}, kImage, simulated.shape, simulated.views, {}, 2));
  EXPECT_FALSE(held_out_error({LensModel::Radial}, kImage, simulated.shape, {}, {}, 2));
}

}  // namespace
}  // namespace alidade
