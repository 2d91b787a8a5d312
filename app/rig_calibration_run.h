// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/camera_calibration_run.h"
#include "app/rig_moments.h"
#include "calib/clocks/clock_offset.h"
#include "calib/rigs/rig_calibration.h"
#include "camera/camera_rig.h"

namespace alidade {

/// A calibration of several cameras as it was run, for those who tell of it.
struct RigCalibrationRun {
  BoardChoice board;
  std::vector<std::string> names;
  std::vector<BoardImages> images;  ///< by camera
  Moments moments;
  std::vector<ClockOffset> clocks{};  ///< by camera, the first one's being the rig's; empty: of one clock
  RigCalibration result;
  double calibration_s = 0;
  std::vector<std::string> warnings;
};

/// What the solver is given: names, sizes, and views with their moments.
std::vector<RigCameraViews> rig_views(const RigCalibrationRun& run);

/// The rig with all its covariances, as it is written.
CameraRig rig_of(const RigCalibrationRun& run);

/// Adds what the user should know of each camera and of the rig.
void add_warnings(RigCalibrationRun& run);

/// The figures with a verdict each, for the report and the terminal.
std::vector<ReportRow> figure_rows(const RigCalibrationRun& run);

/// The content of summary.json.
nlohmann::json summary_of(const RigCalibrationRun& run);

}  // namespace alidade
