// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "camera/camera.h"

namespace alidade {

/// The lenses that a calibration can find, from few to many parameters.
enum class LensModel {
  Radial,    ///< fx fy cx cy k1 k2 p1 p2
  Brown,     ///< and k3
  Rational,  ///< and k4 k5 k6
  Fisheye,   ///< fx fy cx cy k1 k2 k3 k4 of the equidistant model
};

std::string_view name_of(LensModel lens);

/// The places in intrinsics() of a camera with this lens that a calibration finds; the others stay 0.
std::vector<int> free_intrinsics(LensModel lens);

/// A camera with this lens and no distortion yet, of a focal length (px) and with its principal point in the middle.
Camera start_camera(LensModel lens, int width, int height, double focal_px);

}  // namespace alidade
