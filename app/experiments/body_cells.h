// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/experiments/body_recording.h"
#include "app/experiments/experiment_section.h"

namespace alidade {

/// One condition in which the methods are compared.
struct BodyCell {
  std::string name;  ///< "30" of "wrong ids (%)": in tables, and the key in summary.json
  BodySceneOptions scene;
};

/// What each method made of a cell.
struct BodyCellScores {
  BodyCell cell;
  double bound_m = 0.0;  ///< RMS of the frames' bounds
  BodyScore paper, paper_backward, ours, smoothed;
};

/// All cells, several at once; fewer where the user stops it.
std::vector<BodyCellScores> score_cells(const std::vector<BodyCell>& cells, const ExperimentContext& context,
                                        const std::string& stage);

/// One row per cell and method.
ReportTable score_table(const std::string& title, const std::string& condition,
                        const std::vector<BodyCellScores>& cells);

/// By cell, then by method.
nlohmann::json summary_of(const std::vector<BodyCellScores>& cells);

}  // namespace alidade
