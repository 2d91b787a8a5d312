// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/options_yaml.h"
#include "calib/cameras/camera_calibration.h"

namespace alidade {

/// The lens that a user asks for: one of LensModel's, or "auto".
enum class LensChoice { Auto, Radial, Brown, Rational, Fisheye };

/// Whether the places of the board's corners are found too, taken as printed, or whichever does better.
enum class CornerChoice { Auto, Printed, Found };

/// What a user may choose about a calibration of cameras.
struct CameraCalibrationChoice {
  LensChoice lens = LensChoice::Auto;
  CornerChoice corners = CornerChoice::Auto;
  CameraCalibrationOptions solver;
};

/// The options with the lens in its place.
CameraCalibrationOptions effective_options(const CameraCalibrationChoice& choice);

/// Binds them to flags and keys of --config. `choice` must outlive `fields`.
void bind(OptionFields& fields, CameraCalibrationChoice& choice);

}  // namespace alidade
