// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "app/experiments/body_cells.h"
#include "app/experiments/body_experiment.h"

namespace alidade {
namespace {

Series series_of(const std::string& name, const std::vector<BodyCellScores>& cells, const std::vector<double>& x,
                 double (*value)(const BodyCellScores&)) {
  Series series{name, x, {}, SeriesStyle::Line, std::nullopt};
  for (const BodyCellScores& cell : cells) series.y.push_back(value(cell));
  return series;
}

// What is asked of each cell, and shown: one section of a sweep over `x`.
ExperimentSection sweep(ExperimentSection section, const ExperimentContext& context, const std::string& condition,
                        const std::vector<double>& x, const std::vector<BodyCell>& cells, Plot plot,
                        const std::string& caption) {
  const auto scores = score_cells(cells, context, section.name);
  if (context.stop.stop_requested()) return section;
  plot.series = {
      series_of("paper", scores, x, [](const BodyCellScores& c) { return 1e3 * c.paper.rms_m; }),
      series_of("paper, backward", scores, x, [](const BodyCellScores& c) { return 1e3 * c.paper_backward.rms_m; }),
      series_of("ours", scores, x, [](const BodyCellScores& c) { return 1e3 * c.ours.rms_m; }),
      series_of("ours, smoothed", scores, x, [](const BodyCellScores& c) { return 1e3 * c.smoothed.rms_m; }),
      series_of("bound of a frame", scores, x, [](const BodyCellScores& c) { return 1e3 * c.bound_m; })};
  plot.series.back().style = SeriesStyle::Dashed;
  section.tables.push_back(score_table(section.title, condition, scores));
  section.summary = summary_of(scores);
  section.figures.push_back({section.name + ".png", caption, {plot}});
  return section;
}

std::string percent(double share) {
  return fmt::format("{:.0f}", 100 * share);
}

}  // namespace

ExperimentSection body_accuracy(const ExperimentContext& context) {
  ExperimentSection section{"accuracy", "Clean data", {}, {}, {}, {}};
  std::vector<BodyCell> clean;
  for (int markers : {3, 4, 8}) {
    BodyCell cell{fmt::format("{} markers", markers), {}};
    cell.scene.markers = markers;
    clean.push_back(cell);
  }
  const auto clean_scores = score_cells(clean, context, "clean data");
  if (context.stop.stop_requested()) return section;
  section.tables.push_back(score_table("Clean data, twelve detectors", "body", clean_scores));
  section.summary["clean"] = summary_of(clean_scores);

  Plot plot{"Clean data", "detectors", "position RMS (mm)", {}, false, false};
  for (int markers : {3, 4}) {
    std::vector<BodyCell> cells;
    std::vector<double> detectors;
    for (int blocks : {2, 3, 4, 6, 8}) {
      detectors.push_back(4 * blocks);
      cells.push_back({std::to_string(4 * blocks), {}});
      cells.back().scene.markers = markers;
      cells.back().scene.blocks = blocks;
    }
    const auto scores = score_cells(cells, context, fmt::format("detectors, {} markers", markers));
    if (context.stop.stop_requested()) return section;
    section.tables.push_back(score_table(fmt::format("{} markers (the paper's Fig. 2)", markers), "detectors", scores));
    section.summary["detectors"][std::to_string(markers)] = summary_of(scores);
    plot.series.push_back(series_of(fmt::format("paper, {} markers", markers), scores, detectors,
                                    [](const BodyCellScores& c) { return 1e3 * c.paper.rms_m; }));
    plot.series.push_back(series_of(fmt::format("ours, {} markers", markers), scores, detectors,
                                    [](const BodyCellScores& c) { return 1e3 * c.ours.rms_m; }));
  }
  section.figures.push_back({"accuracy.png", "Accuracy against the number of detectors (the paper's Fig. 2).", {plot}});
  return section;
}

ExperimentSection body_wrong_ids(const ExperimentContext& context) {
  std::vector<BodyCell> cells;
  std::vector<double> x;
  for (double share : {0.0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.45}) {
    cells.push_back({percent(share), {}});
    cells.back().scene.wrong_ids = share;
    x.push_back(100 * share);
  }
  return sweep({"wrong-ids", "Readings that bear the id of another marker", {}, {}, {}, {}}, context, "wrong ids (%)",
               x, cells, {"Wrong ids", "wrong ids (%)", "position RMS (mm)", {}, false, true},
               "Error against the share of wrong ids; four markers, twelve detectors.");
}

ExperimentSection body_occlusion(const ExperimentContext& context) {
  std::vector<BodyCell> cells;
  std::vector<double> x;
  for (double share : {0.0, 0.2, 0.4, 0.6}) {
    cells.push_back({percent(share), {}});
    cells.back().scene.occluded = share;
    x.push_back(100 * share);
  }
  return sweep({"occlusion",
                "Readings that are hidden in bursts",
                {"Of the paper's method, frames of which it says itself that their planes hardly span space are not "
                 "answered; of ours, those of which it is less sure than 1 cm or 0.05 rad along any axis."},
                {},
                {},
                {}},
               context, "hidden (%)", x, cells,
               {"Occlusion", "hidden readings (%)", "position RMS (mm)", {}, false, true},
               "Error against the share of hidden readings; four markers, twelve detectors.");
}

}  // namespace alidade
