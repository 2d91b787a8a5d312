// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/detector_verification.h"
#include "app/result_directory.h"
#include "view/plot.h"
#include "view/scene.h"

namespace alidade {

/// A calibration of detectors as it was run, for those who tell of it.
struct DetectorCalibrationRun {
  std::string source;                  ///< the observations
  DetectorCalibration given, refined;  ///< `given`: only detectors and body
  std::optional<DetectorVerification> verification;
  bool has_reference = false;
  bool interrupted = false;
  double calibration_s = 0.0;
  std::vector<std::string> warnings;
};

/// How far a station moved from where it was given, and how sure that is.
struct StationMove {
  std::string station;
  Vector6d change = Vector6d::Zero();  ///< of T_world_station, along its own axes; m, rad
  std::optional<Vector6d> sigma;       ///< empty: it was held
};
std::vector<StationMove> station_moves(const DetectorCalibrationRun& run);

/// Why there is no answer, and what to do about it.
std::string explain(CalibrationOutcome outcome);

/// Adds what the user should know of a calibration that is not all that was asked for.
void add_warnings(DetectorCalibrationRun& run);

/// The content of summary.json.
nlohmann::json summary_of(const DetectorCalibrationRun& run);

/// The lines that end the command's output.
std::vector<std::string> table_lines(const DetectorCalibrationRun& run);

/// Residuals by detector and marker before and after, where verified, and how far the stations moved.
std::vector<Plot> plots_of(const DetectorCalibrationRun& run);

/// Stations where they were given and where they are, with the ellipsoids of their positions, and the body's path.
Scene scene_of(const DetectorCalibrationRun& run);

/// Writes detectors.yaml, body.csv, trajectory.tum, stations.csv, residuals.csv, pictures, options.yaml and
/// report.html; the commit is the caller's. A machine that cannot draw gets all but scene.png, with a warning.
void write_calibration(DetectorCalibrationRun& run, const ResultDirectory& directory,
                       const std::vector<std::string>& arguments, const std::string& options_yaml);

}  // namespace alidade
