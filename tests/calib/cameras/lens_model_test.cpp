// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/lens_model.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(LensModel, HasNoMoreFreeParametersThanItsCamera) {
  for (const LensModel lens : {LensModel::Radial, LensModel::Brown, LensModel::Rational, LensModel::Fisheye}) {
    const Camera camera = start_camera(lens, 640, 480, 500);
    EXPECT_LT(free_intrinsics(lens).back(), intrinsics(camera).size()) << name_of(lens);
    EXPECT_FALSE(find_fault(camera)) << name_of(lens);
  }
}

}  // namespace
}  // namespace alidade
