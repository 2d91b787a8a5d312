// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/experiments/targets_experiment.h"
#include "datasets/target_scene.h"
#include "evaluation/statistics.h"
#include "evaluation/target_detection.h"
#include "uav/batch/motion_bound.h"
#include "uav/paper/paper_tracker.h"
#include "uav/window/window_association.h"

namespace alidade {
namespace {

constexpr double kFound_m = 4.2;
constexpr double kNoise_m = 0.1;

// What is printed of a cell: mean and standard deviation of d (m), and Pr_m where it is told.
struct Printed {
  double mean, sd;
  std::optional<double> all_found{};
};

struct Cell {
  std::string name;
  PaperMethod method;
  int targets;
  std::vector<double> delays_s;
  Printed paper;
  std::optional<Printed> page{}, page_bearings{};  // re-created there; the latter with noise on the bearings
};

std::vector<Cell> all_cells() {
  using enum PaperMethod;
  return {
      {"alternative m=1 .1", Alternative, 1, {0.0, 0.1}, {1.25, 0.89, 1.0}, {}, Printed{1.26, 1.08, 0.98}},
      {"alternative m=1 .25", Alternative, 1, {0.0, 0.25}, {3.10, 2.30, 0.71}, {}, Printed{3.06, 2.46, 0.73}},
      {"alternative m=2 .1", Alternative, 2, {0.0, 0.1}, {1.28, 1.03, 0.97}, {}, Printed{1.46, 1.11, 0.91}},
      {"alternative m=2 .25", Alternative, 2, {0.0, 0.25}, {3.30, 2.40, 0.60}, {}, Printed{3.06, 2.41, 0.59}},
      {"proposed m=1 .1/.2", Proposed, 1, {0.0, 0.1, 0.2}, {0.15, 0.07, 1.0}, Printed{0.16, 0.07}, Printed{0.27, 0.17}},
      {"proposed m=1 .3/.4", Proposed, 1, {0.0, 0.3, 0.4}, {0.15, 0.07, 1.0}, Printed{0.16, 0.07}, Printed{0.52, 0.48}},
      {"proposed m=2 .1/.2", Proposed, 2, {0.0, 0.1, 0.2}, {0.37, 0.95, 0.96}, {}, {}},
      {"proposed m=2 .3/.4", Proposed, 2, {0.0, 0.3, 0.4}, {0.55, 1.34, 0.95}, {}, {}}};
}

// What one run of a cell gives.
struct Run {
  DetectionOutcome on_bearings, on_vectors, batch;
  std::optional<double> period_bound_m, window_bound_m;  // RMS of the first target's position in the last period
};

struct CellResult {
  Cell cell;
  DetectionStatistics on_bearings, on_vectors, batch;
  double period_bound_m = 0.0, window_bound_m = 0.0;  // medians over runs; 0: not determined
};

struct Scene {
  TargetScene scene;
  std::vector<Bearing> bearings;
  Timestamp last_period;
  std::vector<Eigen::Vector3d> truth;  // when the last period begins
};

Scene scene_of(const Cell& cell, unsigned seed, double noise_m, double velocity_sigma_m_s = 15.6) {
  TargetSceneOptions options = paper_table_scene(cell.targets, cell.delays_s, seed);
  options.velocity_sigma_m_s = velocity_sigma_m_s;
  options.sigma_m = noise_m;
  Scene made{make_target_scene(options), {}, Timestamp(from_seconds((options.periods - 1) * options.period_s)), {}};
  made.bearings = bearings_of(made.scene.receivers, made.scene.readings);
  if (cell.method == PaperMethod::Alternative) {  // it looks at two receivers, and so does what stands beside it
    std::erase_if(made.bearings, [](const Bearing& bearing) { return bearing.receiver > 1; });
  }
  for (const TargetPath& path : made.scene.paths) made.truth.push_back(position_at(path, made.last_period));
  return made;
}

PaperOptions options_of(const Cell& cell) {
  PaperOptions options;
  options.method = cell.method;
  return options;
}

DetectionOutcome paper_on_bearings(const Cell& cell, const Scene& scene) {
  std::vector<Eigen::Vector3d> found;
  for (const PaperTarget& target : locate_paper_targets(scene.bearings, options_of(cell))) {
    found.push_back(target.state.p_world);
  }
  return detect_targets(found, scene.truth, kFound_m);
}

// The other reading: bearings without error, and the noise upon each vector that is found.
DetectionOutcome paper_on_vectors(const Cell& cell, const Scene& exact, unsigned seed) {
  const PaperOptions options = options_of(cell);
  std::vector<PaperPeriod> periods = paper_candidates(exact.bearings, options);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, kNoise_m);
  for (PaperPeriod& period : periods) {
    for (PaperCandidate& candidate : period.candidates) {
      for (double& x : candidate.state.p_world) x += normal(random);
    }
  }
  std::vector<Eigen::Vector3d> found;
  for (const PaperGroup& group : choose_objects(periods, paper_groups(periods, options), options)) {
    found.push_back(group.estimate.p_world);
  }
  return detect_targets(found, exact.truth, kFound_m);
}

DetectionOutcome batch_on_bearings(const Scene& scene) {
  WindowOptions options;
  options.detection_probability = 0.999;  // everything is seen, and nothing else
  options.false_bearings_per_sr = 0.01;
  options.top_speed_m_s = 120.0;
  std::vector<Eigen::Vector3d> found;
  for (const TargetHypothesis& target : associate_window(scene.bearings, options)) {
    found.push_back(moved_to(target.fit.state, scene.last_period).p_world);
  }
  return detect_targets(found, scene.truth, kFound_m);
}

std::optional<double> bound_of(const Scene& scene, bool is_last_period_only) {
  const TargetPath& path = scene.scene.paths.front();
  TargetState truth;
  truth.time = scene.last_period;
  truth.p_world = position_at(path, truth.time);
  truth.v_world = velocity_at(path, truth.time);
  std::vector<Bearing> bearings;
  for (const Bearing& bearing : scene.bearings) {
    const bool counts = !is_last_period_only || bearing.time >= scene.last_period;
    if (counts && bearing.target == path.target) bearings.push_back(bearing);
  }
  const auto bound = motion_bound(truth, bearings, MotionModel::Velocity);
  if (!bound) return std::nullopt;
  return std::sqrt(bound->topLeftCorner<3, 3>().trace());
}

Run run_of(const Cell& cell, unsigned seed) {
  const Scene noisy = scene_of(cell, seed, kNoise_m), exact = scene_of(cell, seed, 0.0);
  return {paper_on_bearings(cell, noisy), paper_on_vectors(cell, exact, seed), batch_on_bearings(noisy),
          bound_of(noisy, true), bound_of(noisy, false)};
}

template <typename Field>
auto gathered(const std::vector<Run>& runs, Field field) {
  std::vector<std::decay_t<decltype(runs.front().*field)>> values;
  for (const Run& run : runs) values.push_back(run.*field);
  return values;
}

double median_of(const std::vector<std::optional<double>>& values) {
  std::vector<double> known;
  for (const auto& value : values) {
    if (value) known.push_back(*value);
  }
  return summarise(known).median;
}

CellResult result_of(const Cell& cell, const ExperimentContext& context) {
  std::vector<Run> runs(static_cast<std::size_t>(context.runs));
  tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t i) {
    if (!context.stop.stop_requested()) runs[i] = run_of(cell, context.seed + static_cast<unsigned>(i));
  });
  return {cell,
          summarise(gathered(runs, &Run::on_bearings)),
          summarise(gathered(runs, &Run::on_vectors)),
          summarise(gathered(runs, &Run::batch)),
          median_of(gathered(runs, &Run::period_bound_m)),
          median_of(gathered(runs, &Run::window_bound_m))};
}

std::string text_of(const MeanWithError& value) {
  return fmt::format("{:.3f} ± {:.3f}", value.value, value.standard_error);
}

std::string bound_text(double bound_m) {
  return bound_m > 0.0 ? fmt::format("{:.3f}", bound_m) : "-";
}

void add_rows(const CellResult& result, ReportTable& table) {
  const auto printed = [&](const std::string& source, const Printed& p) {
    table.rows.push_back({result.cell.name, source, fmt::format("{:.2f}", p.mean), fmt::format("{:.2f}", p.sd),
                          p.all_found ? fmt::format("{:.2f}", *p.all_found) : "", "", "", ""});
  };
  const auto measured = [&](const std::string& source, const DetectionStatistics& s) {
    table.rows.push_back({result.cell.name, source, text_of(s.distance_mean_m), text_of(s.distance_sd_m),
                          text_of(s.all_found), text_of(s.right_number), bound_text(result.period_bound_m),
                          bound_text(result.window_bound_m)});
  };
  printed("paper", result.cell.paper);
  if (result.cell.page) printed("page, noise on vectors", *result.cell.page);
  measured("here, noise on vectors", result.on_vectors);
  if (result.cell.page_bearings) printed("page, noise on bearings", *result.cell.page_bearings);
  measured("here, noise on bearings", result.on_bearings);
  measured("ours (stamped batch)", result.batch);
}

nlohmann::json json_of(const DetectionStatistics& s) {
  const auto pair = [](const MeanWithError& m) {
    return nlohmann::json{{"value", m.value}, {"standard_error", m.standard_error}};
  };
  return {{"runs", s.runs},
          {"d_mean_m", pair(s.distance_mean_m)},
          {"d_sd_m", pair(s.distance_sd_m)},
          {"all_found", pair(s.all_found)},
          {"right_number", pair(s.right_number)},
          {"false_per_run", s.false_per_run}};
}

nlohmann::json json_of(const Printed& p) {
  nlohmann::json json{{"d_mean_m", p.mean}, {"d_sd_m", p.sd}};
  if (p.all_found) json["all_found"] = *p.all_found;
  return json;
}

nlohmann::json json_of(const CellResult& result) {
  nlohmann::json json{{"on_bearings", json_of(result.on_bearings)},
                      {"on_vectors", json_of(result.on_vectors)},
                      {"batch", json_of(result.batch)},
                      {"batch_to_paper", result.batch.distance_mean_m.value / result.on_bearings.distance_mean_m.value},
                      {"window_bound_m", result.window_bound_m}};
  json["paper"] = json_of(result.cell.paper);
  if (result.cell.page) json["page_on_vectors"] = json_of(*result.cell.page);
  if (result.cell.page_bearings) json["page_on_bearings"] = json_of(*result.cell.page_bearings);
  if (result.period_bound_m > 0.0) json["period_bound_m"] = result.period_bound_m;
  // With targets that stand still the lines of sight stay orthogonal: what the page states.
  if (const auto bound = bound_of(scene_of(result.cell, 1, kNoise_m, 0.0), true)) json["orthogonal_bound_m"] = *bound;
  return json;
}

}  // namespace

ExperimentSection targets_tables(const ExperimentContext& context) {
  ExperimentSection section{
      "tables",
      "The paper's Tables 1 and 2",
      {"d: distance between found and true position in the last of five periods, mean and standard deviation over all "
       "runs, also beyond 4.2 m; Pr_m: all m found, within 4.2 m. ±: standard error, by bootstrap over runs.",
       "0.1 m of noise on each found vector, or across each line of sight; the paper does not say which.",
       "Bounds (Cramér-Rao, RMS of the position, median over runs): of the last period's bearings alone, and of all. "
       "The receivers' lines are orthogonal in the middle of the time; the faster the targets, the less so at its end, "
       "which gives d a heavy tail."},
      {},
      {},
      {}};
  ReportTable table{fmt::format("{} runs of each cell; d in m", context.runs),
                    {"cell", "source", "d mean", "d sd", "Pr_m", "P(right number)", "bound, period", "bound, window"},
                    {}};
  const std::vector<Cell> cells = all_cells();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const CellResult result = result_of(cells[i], context);
    if (context.stop.stop_requested()) return section;
    add_rows(result, table);
    section.summary[cells[i].name] = json_of(result);
    if (context.progress) {
      context.progress({"tables", static_cast<std::int64_t>(i + 1), static_cast<std::int64_t>(cells.size()), ""});
    }
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
