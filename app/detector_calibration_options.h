// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/options_yaml.h"
#include "calib/detectors/detector_calibration.h"
#include "calib/detectors/window_fit.h"

namespace alidade {

/// What a user may choose about a calibration of detectors.
struct DetectorCalibrationChoice {
  DetectorCalibrationOptions solver;
  WindowFitOptions windows;
  double reference_sigma_m = 2e-3;  ///< motion capture under motion, its clock's error included
  bool rotor_times = true;          ///< of laser sweeps that were stamped late (see time_by_rotors)
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const DetectorCalibrationChoice& choice);

/// Binds them to flags and keys of --config. `choice` must outlive `fields`.
void bind(OptionFields& fields, DetectorCalibrationChoice& choice);

}  // namespace alidade
