// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/targets/receiver_calibration_run.h"

namespace alidade {

/// Adds what the user should know: which receivers were left as given, and what is wrong with others, with a remedy.
void add_warnings(ReceiverCalibrationRun& run, const ReceiverCalibrationChoice& choice);

/// Why there is no answer at all, and what to do about it: one line.
std::string explain_no_answer(const ReceiverCalibrationRun& run);

/// The content of summary.json.
nlohmann::json summary_of(const ReceiverCalibrationRun& run);

/// The lines that end the command's output.
std::vector<std::string> table_lines(const ReceiverCalibrationRun& run);

}  // namespace alidade
