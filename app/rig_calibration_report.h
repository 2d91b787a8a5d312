// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/result_directory.h"
#include "app/rig_calibration_run.h"
#include "view/scene.h"

namespace alidade {

/// Where the cameras stand and where the boards were.
Scene scene_of(const RigCalibrationRun& run);

/// Writes rig.yaml (with covariances), a corners CSV and pictures of every camera, options.yaml and report.html; the
/// commit is the caller's. A machine that cannot draw gets all but scene.png, with a warning.
void write_rig_calibration(RigCalibrationRun& run, const ResultDirectory& directory,
                           const std::vector<std::string>& arguments, const std::string& options_yaml);

}  // namespace alidade
