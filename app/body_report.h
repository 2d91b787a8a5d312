// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/body_record.h"
#include "view/plot.h"

namespace alidade {

/// The content of summary.json.
nlohmann::json summary_of(const BodyRun& run);

/// The lines that end the command's output.
std::vector<std::string> table_lines(const BodyRun& run);

/// Position, attitude, their standard deviations and the share of readings explained, over time from the run's begin.
/// Times without a tracked pose are gaps.
std::vector<Plot> plots_of(const BodyRun& run, std::size_t body);

/// Writes scene.png, plots.png (of several bodies plots_1.png and so on), options.yaml and report.html; the commit
/// is the caller's. A machine that cannot draw gets all but scene.png, with a warning in the run.
void write_body_report(BodyRun& run, const ResultDirectory& directory, const std::vector<std::string>& arguments,
                       const std::string& options_yaml);

}  // namespace alidade
