// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/options_yaml.h"
#include "calib/receivers/receiver_checks.h"
#include "calib/receivers/resection.h"
#include "calib/receivers/spline_bundle.h"

namespace alidade {

/// What a user may choose about a calibration of receivers.
struct ReceiverCalibrationChoice {
  ResectionOptions resection;  ///< with a known path
  ReceiverCheckOptions checks;
  SplineBundleOptions bundle;  ///< without; its time_receiver is the next one's
  std::string time_receiver;   ///< name of the receiver whose clock is the common one; empty: the first
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const ReceiverCalibrationChoice& choice);

/// Binds them to flags and keys of --config. `choice` must outlive `fields`.
void bind(OptionFields& fields, ReceiverCalibrationChoice& choice);

}  // namespace alidade
