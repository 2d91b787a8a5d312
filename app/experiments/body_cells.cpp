// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/body_cells.h"

#include <cmath>
#include <mutex>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace alidade {
namespace {

struct NamedScore {
  const char* name;
  const BodyScore& score;
};

std::vector<NamedScore> methods_of(const BodyCellScores& cell) {
  return {{"paper", cell.paper},
          {"paper, backward", cell.paper_backward},
          {"ours", cell.ours},
          {"ours, smoothed", cell.smoothed}};
}

BodyCellScores score_cell(const BodyCell& cell) {
  const BodyRecording recording = record_body(cell.scene);
  BodyCellScores scores{cell, 0.0, {}, {}, {}, {}};
  double sum = 0;
  int count = 0;
  for (const auto& bound : recording.bounds) {
    if (!bound) continue;
    sum += bound->position_m2;
    ++count;
  }
  scores.bound_m = std::sqrt(sum / count);
  const PaperAnswers paper = track_by_paper(recording);
  scores.paper = score_of(recording, paper.forward);
  scores.paper_backward = score_of(recording, paper.backward);
  const OurAnswers ours = track_by_ours(recording);
  scores.ours = score_of(recording, ours.forward);
  scores.smoothed = score_of(recording, ours.smoothed);
  return scores;
}

}  // namespace

std::vector<BodyCellScores> score_cells(const std::vector<BodyCell>& cells, const ExperimentContext& context,
                                        const std::string& stage) {
  std::vector<BodyCellScores> scores(cells.size());
  std::mutex mutex;
  int done = 0;
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t i) {
    if (context.stop.stop_requested()) return;
    BodyCell cell = cells[i];
    cell.scene.seed = context.seed;
    cell.scene.frames = context.runs;
    scores[i] = score_cell(cell);
    const std::scoped_lock lock(mutex);
    if (context.progress) context.progress({stage, ++done, static_cast<std::int64_t>(cells.size()), ""});
  });
  return scores;
}

ReportTable score_table(const std::string& title, const std::string& condition,
                        const std::vector<BodyCellScores>& cells) {
  ReportTable table{title,
                    {condition, "method", "answered (%)", "position RMS (mm)", "/ bound", "worst (mm)",
                     "rotation RMS (deg)", "/ bound", "NEES per dof"},
                    {}};
  for (const BodyCellScores& cell : cells) {
    for (const auto& [name, s] : methods_of(cell)) {
      table.rows.push_back(
          {cell.cell.name, name, fmt::format("{:.2f}", 100 * s.answered_share), fmt::format("{:.4f}", 1e3 * s.rms_m),
           fmt::format("{:.3f}", s.position_to_bound), fmt::format("{:.3f}", 1e3 * s.worst_m),
           fmt::format("{:.5f}", s.rms_rad * 180.0 / std::numbers::pi), fmt::format("{:.3f}", s.rotation_to_bound),
           s.nees_per_dof ? fmt::format("{:.3f}", *s.nees_per_dof) : "-"});
    }
  }
  return table;
}

nlohmann::json summary_of(const std::vector<BodyCellScores>& cells) {
  nlohmann::json summary;
  for (const BodyCellScores& cell : cells) {
    nlohmann::json& of_cell = summary[cell.cell.name];
    of_cell["bound_m"] = cell.bound_m;
    for (const auto& [name, s] : methods_of(cell)) {
      of_cell[name] = {{"answered_share", s.answered_share},
                       {"position_rms_m", s.rms_m},
                       {"position_to_bound", s.position_to_bound},
                       {"worst_m", s.worst_m},
                       {"rotation_rms_rad", s.rms_rad},
                       {"rotation_to_bound", s.rotation_to_bound}};
      if (s.nees_per_dof) of_cell[name]["nees_per_dof"] = *s.nees_per_dof;
    }
  }
  return summary;
}

}  // namespace alidade
