// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/experiments/experiment_section.h"
#include "app/result_directory.h"

namespace alidade {

/// An experiment as it was run.
struct ExperimentRecord {
  std::string object;  ///< what was looked at, in words
  int runs = 0;
  bool interrupted = false;
  std::vector<ExperimentSection> sections;
};

/// The content of summary.json: by section.
nlohmann::json summary_of(const ExperimentRecord& record);

/// Tables as CSV, pictures, report.html and options.yaml.
void write_experiment(const ExperimentRecord& record, const std::vector<std::string>& arguments,
                      const std::string& options, const ResultDirectory& directory);

}  // namespace alidade
