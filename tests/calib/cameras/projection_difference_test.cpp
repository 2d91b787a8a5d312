// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/projection_difference.h"

#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

CameraCalibration calibration(unsigned seed) {
  const auto simulated =
      test::simulate_views(test::simulated_camera(LensModel::Radial), {.views = 12, .noise_px = 0.1}, seed);
  CameraCalibrationOptions options;
  options.lens = LensModel::Radial;
  options.free_corners = false;
  return calibrate_camera({640, 480}, test::simulated_board(), simulated.views, options);
}

TEST(CompareProjections, FindsNoGapBetweenACalibrationAndItself) {
  const auto c = calibration(1);
  const auto gaps = compare_projections(c, c, test::simulated_board());
  EXPECT_GT(gaps.size(), 400U);  // 24 by 18
  for (const ProjectionGap& gap : gaps) EXPECT_LT(gap.gap_px.norm(), 1e-9);
}

// 90 % regions of independent calibrations: places of one image go together, so that few pairs say little.
TEST(CompareProjections, FindsGapsThatBothState) {
  int within = 0, count = 0;
  for (unsigned seed = 1; seed < 13; seed += 2) {
    for (const ProjectionGap& gap :
         compare_projections(calibration(seed), calibration(seed + 1), test::simulated_board())) {
      within += gap.chi2 < 4.605;
      ++count;
    }
  }
  EXPECT_GT(within, 0.7 * count);
}

TEST(CompareProjections, OfAnotherCameraAreOutsideWhatIsStated) {
  const auto c = calibration(1);
  auto other = c;
  other.camera.fx *= 1.05;
  other.fit.bundle.cameras.front().camera = other.camera;
  int within = 0;
  const auto gaps = compare_projections(c, other, test::simulated_board());
  for (const ProjectionGap& gap : gaps) within += gap.chi2 < 4.605;
  EXPECT_LT(within, 0.2 * static_cast<double>(gaps.size()));
}

}  // namespace
}  // namespace alidade
