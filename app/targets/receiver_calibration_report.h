// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/result_directory.h"
#include "app/targets/receiver_calibration_run.h"

namespace alidade {

/// Writes receivers.yaml, trajectory.tum (where the path was found), scene.png, options.yaml and report.html; the
/// commit is the caller's. A machine that cannot draw gets all but scene.png, with a warning in the run.
void write_calibration(ReceiverCalibrationRun& run, const ResultDirectory& directory,
                       const std::vector<std::string>& arguments, const std::string& options_yaml);

}  // namespace alidade
