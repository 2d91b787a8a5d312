// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/detector_verification.h"

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

}  // namespace alidade
