// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/detector_calibration_options.h"
#include "calib/detectors/detector_calibration.h"
#include "evaluation/statistics.h"
#include "geometry/positions.h"

namespace alidade {

/// What a calibration is verified on: readings that it has not seen, and what else tells where the body was.
struct VerificationData {
  std::string source;
  std::vector<LineReading> readings;
  std::vector<TimedPosition> reference;  ///< of a point of the body, in a frame of its own; may be empty
  std::vector<TimedPosition> onboard;    ///< another estimate to compare with; may be empty
};

/// Errors against the reference, each estimate after its own rigid alignment.
struct ReferenceErrors {
  int asked = 0;                 ///< instants at which the reference tells where the body was
  int answered = 0;              ///< of these, by the estimate with the refined detectors
  Statistics before_m, after_m;  ///< with the detectors as given; refined
  std::optional<Statistics> onboard_m;

  double answered_share() const { return asked > 0 ? static_cast<double>(answered) / asked : 0.0; }
};

/// What the refined detectors are worth on another recording. They are held; only the motion is estimated anew.
struct DetectorVerification {
  DetectorCalibration before, after;  ///< with detectors and body as given; as refined
  WindowStatistics windows;           ///< with the refined ones, each window by itself
  std::optional<ReferenceErrors> errors;
};

/// Estimates the motion twice and compares. `given` and `refined` have their detectors in the same order;
/// `context.reference` is not used. After a stop some of it is missing.
DetectorVerification verify_detectors(const DetectorCalibration& given, const DetectorCalibration& refined,
                                      const VerificationData& data, const DetectorCalibrationChoice& choice,
                                      const CalibrationContext& context);

/// Errors of the body's origin in both motions, and of the other estimate, at the other estimate's instants or, without
/// one, at the reference's. Empty where nothing is to be compared or an alignment is not determined.
std::optional<ReferenceErrors> reference_errors(const DetectorVerification& verification, const VerificationData& data);

}  // namespace alidade
