// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/opencv_calibration.h"

#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

constexpr ImageExtent kImage{640, 480};

TEST(CalibrateByOpencv, FindsTheCameraOfExactViews) {
  const Camera truth = test::simulated_camera(LensModel::Radial);
  const auto simulated = test::simulate_views(truth, {}, 3);
  const auto found = calibrate_by_opencv(kImage, shape_of(test::simulated_board()), simulated.views);
  ASSERT_TRUE(found);
  EXPECT_LT(found->rms_px, 1e-3);  // OpenCV takes corners as float
  EXPECT_LT(test::largest_difference_px(truth, found->camera), 0.02);
}

TEST(CalibrateByOpencv, IsEmptyWithoutViews) {
  EXPECT_FALSE(calibrate_by_opencv(kImage, shape_of(test::simulated_board()), {}));
}

}  // namespace
}  // namespace alidade
