// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/detector_calibration_run.h"
#include "app/result_directory.h"
#include "view/plot.h"
#include "view/scene.h"

namespace alidade {

/// Residuals by detector and marker before and after, where verified, and how far the stations moved.
std::vector<Plot> plots_of(const DetectorCalibrationRun& run);

/// Stations where they were given and where they are, with the ellipsoids of their positions, and the body's path.
Scene scene_of(const DetectorCalibrationRun& run);

/// Writes detectors.yaml, body.csv, trajectory.tum, stations.csv, residuals.csv, pictures, options.yaml and
/// report.html; the commit is the caller's. A machine that cannot draw gets all but scene.png, with a warning.
void write_calibration(DetectorCalibrationRun& run, const ResultDirectory& directory,
                       const std::vector<std::string>& arguments, const std::string& options_yaml);

}  // namespace alidade
