// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/command.h"
#include "app/experiments/experiment_section.h"

namespace alidade {

/// An experiment as it was run.
struct ExperimentRecord {
  std::string object;         ///< what was looked at, in words
  std::string unit = "runs";  ///< what there are so many of; the key in summary.json
  int count = 0;
  bool interrupted = false;
  std::vector<ExperimentSection> sections;
};

/// The content of summary.json: by section.
nlohmann::json summary_of(const ExperimentRecord& record);

/// A section's tables and remarks, for the user.
void tell(const ExperimentSection& section, const RunContext& context);

/// Publishes an experiment that has ended or was interrupted, and writes it where an output was asked for: tables as
/// CSV, pictures, report.html, options.yaml and summary.json. `verb`: "experiment camera".
ExitCode finish(const ExperimentRecord& record, const std::string& verb, const std::string& options,
                const RunContext& context);

}  // namespace alidade
