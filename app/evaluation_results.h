// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/evaluate.h"
#include "io/trajectory_file.h"

namespace alidade {

/// An evaluation and what it was made from, for those who write it down.
struct EvaluationRecord {
  TrajectoryFile estimate;
  TrajectoryFile truth;
  bool by_index = false;  ///< pose i with pose i; else by time
  AssociationOptions association;
  EvaluationOptions options;
  Evaluation evaluation;
};

/// "none", "se3" or "sim3".
std::string name_of(AlignmentKind alignment);

/// "1 frame", "2 frames", "10 m", "0.5 s".
std::string name_of(const Step& step);

/// The lines of the table for the terminal: six decimals, as evo prints.
std::vector<std::string> table_lines(const EvaluationRecord& record);

/// The content of summary.json: numbers with their units in the names.
nlohmann::json summary_of(const EvaluationRecord& record);

/// The content of errors.csv: t_ns of the truth, translation_m, rotation_deg, of_path_percent, nees (empty without a
/// covariance), of every associated pose.
std::string errors_csv(const EvaluationRecord& record);

}  // namespace alidade
