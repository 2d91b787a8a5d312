// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/targets/receiver_calibration_input.h"
#include "app/targets/receiver_calibration_options.h"
#include "app/targets/receiver_calibration_residuals.h"
#include "core/progress.h"

namespace alidade {

/// A receiver before and after.
struct CalibratedReceiver {
  Receiver given, found;  ///< the same where there is no answer
  std::string left_why;   ///< why it was left as given; empty: it was calibrated
  /// From given to found: pose, the clock's offset at the found one's reference, its rate, rolling shutter and the
  /// focal lengths' logarithm.
  ReceiverChange change = ReceiverChange::Zero();
  std::optional<ReceiverChange> sigma;  ///< standard deviations of what was found, where they are told
  std::optional<double> wander_px;      ///< what no pose and clock explain, where it is told
  ReceiverResiduals before, after;      ///< about the path, which is the same in both

  bool is_calibrated() const { return left_why.empty(); }
};

/// A calibration of receivers as it was run, for those who tell of it.
struct ReceiverCalibrationRun {
  ReceiverCalibrationSources sources;
  std::vector<CalibratedReceiver> receivers;  ///< all, in the order given
  std::vector<ReceiverFinding> findings;      ///< with a known path
  std::vector<TimedPosition> path;            ///< known, or found; while somebody saw it
  bool is_interrupted = false;                ///< and something is missing
  double calibration_s = 0.0;
  std::vector<std::string> warnings;

  bool has_truth() const { return !sources.truth.empty(); }
  bool has_answer() const;
};

/// Who watches a calibration, and may stop it.
struct CalibrationWatch {
  ProgressSink progress;
  std::stop_token stop;
};

/// Resects cameras where the path is known, one by one, and looks for faults of them; else finds path and cameras
/// together. Direction finders, and cameras with too few readings, stay as given. After a stop it is interrupted, and
/// what is not yet calibrated is as given. Throws InputError for options that do not fit the receivers.
ReceiverCalibrationRun calibrate_receivers(const ReceiverCalibrationInput& input,
                                           const ReceiverCalibrationChoice& choice, const CalibrationWatch& watch);

/// What it is called, or, where it has no name, "receiver 3".
std::string name_of(const Receiver& receiver);

/// The change that makes `given` what was `found`.
ReceiverChange change_between(const Receiver& given, const Receiver& found);

}  // namespace alidade
