// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/experiments/cpu_clock.h"
#include "app/experiments/targets_experiment.h"
#include "datasets/target_scene.h"
#include "evaluation/statistics.h"
#include "evaluation/target_detection.h"
#include "uav/window/window_association.h"

namespace alidade {
namespace {

constexpr double kFound_m = 4.2;

struct Cell {
  std::string name;
  TargetSceneOptions scene;
};

// Five targets, three receivers, Pd 0.9, one false bearing in a scan, delays .1/.2.
TargetSceneOptions usual_scene() {
  TargetSceneOptions scene;
  scene.targets = 5;
  scene.detection_probability = 0.9;
  scene.false_bearings = 1.0;
  return scene;
}

template <typename Change>
void add_cell(std::vector<Cell>& cells, const std::string& name, Change change) {
  cells.push_back({name, usual_scene()});
  change(cells.back().scene);
}

std::vector<Cell> all_cells() {
  std::vector<Cell> cells;
  for (const int m : {1, 2, 5, 10, 20}) add_cell(cells, fmt::format("m {}", m), [&](auto& s) { s.targets = m; });
  add_cell(cells, "m 2, Pd 0.8, 3 false", [](auto& s) {
    s.targets = 2;
    s.detection_probability = 0.8;
    s.false_bearings = 3.0;
  });
  for (const double pd : {0.7, 0.8, 0.95, 1.0}) {
    add_cell(cells, fmt::format("Pd {}", pd), [&](auto& s) { s.detection_probability = pd; });
  }
  for (const int count : {0, 3, 5}) {
    add_cell(cells, fmt::format("{} false", count), [&](auto& s) { s.false_bearings = count; });
  }
  add_cell(cells, "no delays", [](auto& s) { s.delays_s = {0.0}; });
  add_cell(cells, "delays .3/.4", [](auto& s) { s.delays_s = {0.0, 0.3, 0.4}; });
  add_cell(cells, "rotating receivers", [](auto& s) { s.scan_law = ScanLaw::Rotating; });
  add_cell(cells, "cued receivers", [](auto& s) { s.scan_law = ScanLaw::Cued; });
  for (const int n : {2, 4, 6}) add_cell(cells, fmt::format("{} receivers", n), [&](auto& s) { s.receivers = n; });
  return cells;
}

// What the receivers are said to do is what they do.
WindowOptions options_for(const TargetSceneOptions& scene) {
  const double cone_sr = 2.0 * std::numbers::pi * (1.0 - std::cos(0.5 * scene.cone_rad));
  WindowOptions options;
  options.period_s = scene.period_s;
  options.detection_probability = std::min(scene.detection_probability, 0.99);
  options.false_bearings_per_sr = std::max(scene.false_bearings, 0.01) / cone_sr;
  return options;
}

struct Run {
  DetectionOutcome ours, oracle;
  double seconds = 0.0;
};

// Each target's own bearings, as nobody can know them.
std::vector<Eigen::Vector3d> oracle_positions(const TargetScene& scene, const std::vector<Bearing>& bearings,
                                              Timestamp time) {
  std::vector<Eigen::Vector3d> positions;
  MotionFitOptions options;
  options.time = time;
  for (const TargetPath& path : scene.paths) {
    std::vector<Bearing> own;
    std::copy_if(bearings.begin(), bearings.end(), std::back_inserter(own),
                 [&](const Bearing& bearing) { return bearing.target == path.target; });
    const MotionAnswer answer = fit_motion(own, options);
    if (answer.fit) positions.push_back(answer.fit->state.p_world);
  }
  return positions;
}

Run run_of(const Cell& cell, unsigned seed) {
  TargetSceneOptions scene_options = cell.scene;
  scene_options.seed = seed;
  const TargetScene scene = make_target_scene(scene_options);
  const std::vector<Bearing> bearings = bearings_of(scene.receivers, scene.readings);
  const Timestamp last_period(from_seconds((scene_options.periods - 1) * scene_options.period_s));
  std::vector<Eigen::Vector3d> truth, found;
  for (const TargetPath& path : scene.paths) truth.push_back(position_at(path, last_period));
  const double begin = thread_seconds();
  const std::vector<TargetHypothesis> hypotheses = associate_window(bearings, options_for(scene_options));
  const double seconds = thread_seconds() - begin;
  for (const TargetHypothesis& h : hypotheses) found.push_back(moved_to(h.fit.state, last_period).p_world);
  return {detect_targets(found, truth, kFound_m),
          detect_targets(oracle_positions(scene, bearings, last_period), truth, kFound_m), seconds};
}

struct CellResult {
  DetectionStatistics ours, oracle;
  Statistics cpu_ms;
};

CellResult result_of(const std::vector<Run>& runs) {
  std::vector<DetectionOutcome> ours, oracle;
  std::vector<double> cpu_ms;
  for (const Run& run : runs) {
    ours.push_back(run.ours);
    oracle.push_back(run.oracle);
    cpu_ms.push_back(1e3 * run.seconds);
  }
  return {summarise(ours), summarise(oracle), summarise(cpu_ms)};
}

std::vector<std::string> row_of(const Cell& cell, const CellResult& r) {
  const auto with_error = [](const MeanWithError& m) {
    return fmt::format("{:.4f} ± {:.4f}", m.value, m.standard_error);
  };
  return {cell.name,
          with_error(r.ours.all_found),
          fmt::format("{:.4f}", r.oracle.all_found.value),
          with_error(r.ours.right_number),
          fmt::format("{:.4f}", r.ours.false_per_run),
          fmt::format("{:.3f}", r.ours.distance_mean_m.value),
          fmt::format("{:.3f}", r.oracle.distance_mean_m.value),
          fmt::format("{:.2f}", r.cpu_ms.mean),
          fmt::format("{:.2f}", r.cpu_ms.max)};
}

nlohmann::json json_of(const CellResult& r) {
  return {{"runs", r.ours.runs},
          {"all_found", r.ours.all_found.value},
          {"oracle_all_found", r.oracle.all_found.value},
          {"right_number", r.ours.right_number.value},
          {"false_per_run", r.ours.false_per_run},
          {"d_mean_m", r.ours.distance_mean_m.value},
          {"oracle_d_mean_m", r.oracle.distance_mean_m.value},
          {"cpu_ms", {{"mean", r.cpu_ms.mean}, {"median", r.cpu_ms.median}, {"max", r.cpu_ms.max}}}};
}

}  // namespace

ExperimentSection targets_window(const ExperimentContext& context) {
  ExperimentSection section{
      "window",
      "Many targets told apart in a window",
      {"m 5, three receivers, five periods, delays .1/.2, Pd 0.9, one false bearing per scan and receiver in a cone of "
       "20 degrees; each cell changes what it names. Targets lie within 15 m, at least 3 m apart, and fly together.",
       "Pr_m: all m found, within 4.2 m in period 5. The oracle is told which bearings are of which target, and "
       "need not prove that there is one. P(number): as many found as there are. d: distance in m.",
       "CPU time of one window, one thread."},
      {},
      {},
      {}};
  ReportTable table{fmt::format("{} runs of each cell", context.runs),
                    {"cell", "Pr_m", "oracle", "P(number)", "false per run", "d mean", "oracle", "CPU (ms)", "worst"},
                    {}};
  const std::vector<Cell> cells = all_cells();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::vector<Run> runs(static_cast<std::size_t>(context.runs));
    tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t run) {
      if (!context.stop.stop_requested()) runs[run] = run_of(cells[i], context.seed + static_cast<unsigned>(run));
    });
    if (context.stop.stop_requested()) return section;
    const CellResult result = result_of(runs);
    table.rows.push_back(row_of(cells[i], result));
    section.summary[cells[i].name] = json_of(result);
    if (context.progress) {
      context.progress({"window", static_cast<std::int64_t>(i + 1), static_cast<std::int64_t>(cells.size()), ""});
    }
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
