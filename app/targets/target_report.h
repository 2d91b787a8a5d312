// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/targets/target_record.h"

namespace alidade {

/// The content of summary.json.
nlohmann::json summary_of(const TargetRun& run);

/// The lines that end the command's output.
std::vector<std::string> table_lines(const TargetRun& run);

/// Writes scene.png, plots.png, options.yaml and report.html; the commit is the caller's. A machine that cannot draw
/// gets all but scene.png, with a warning in the run. `truth` (may be empty) is drawn beside the tracks.
void write_target_report(TargetRun& run, std::span<const TargetRow> truth, const ResultDirectory& directory,
                         const std::vector<std::string>& arguments, const std::string& options_yaml);

}  // namespace alidade
