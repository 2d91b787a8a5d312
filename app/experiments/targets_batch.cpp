// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/experiments/cpu_clock.h"
#include "app/experiments/targets_experiment.h"
#include "datasets/target_scene.h"
#include "evaluation/ensemble.h"
#include "evaluation/error_consistency.h"
#include "uav/batch/motion_bound.h"
#include "uav/batch/motion_fit.h"

namespace alidade {
namespace {

constexpr double kAcceleration_m_s2 = 3.0;

struct Cell {
  std::string name;
  int receivers;
  std::vector<double> delays_s;
  MotionModel model;
};

std::vector<Cell> all_cells() {
  const std::vector<double> shorter{0.0, 0.1, 0.2}, longer{0.0, 0.3, 0.4};
  std::vector<Cell> cells;
  for (const int n : {2, 3, 4, 6}) cells.push_back({fmt::format("{} receivers", n), n, shorter, MotionModel::Velocity});
  cells.push_back({"3 receivers, .3/.4", 3, longer, MotionModel::Velocity});
  for (const int n : {2, 3, 4, 6}) {
    cells.push_back({fmt::format("{} receivers, accelerating", n), n, shorter, MotionModel::Acceleration});
  }
  return cells;
}

// What one run gives; nothing where the motion was not determined.
struct Run {
  bool is_determined = false;
  double squared_error_m2 = 0.0, squared_bound_m2 = 0.0, chi2 = 0.0, seconds = 0.0;
  int degrees = 0;
  Eigen::VectorXd error;
  Eigen::MatrixXd covariance;
};

TargetState truth_at(const TargetPath& path, Timestamp time) {
  TargetState truth;
  truth.time = time;
  truth.p_world = position_at(path, time);
  truth.v_world = velocity_at(path, time);
  truth.a_world = path.a_world;
  return truth;
}

Run run_of(const Cell& cell, unsigned seed) {
  TargetSceneOptions scene_options;
  scene_options.targets = 1;
  scene_options.receivers = cell.receivers;
  scene_options.delays_s = cell.delays_s;
  scene_options.acceleration_m_s2 = cell.model == MotionModel::Acceleration ? kAcceleration_m_s2 : 0.0;
  scene_options.seed = seed;
  const TargetScene scene = make_target_scene(scene_options);
  const std::vector<Bearing> bearings = bearings_of(scene.receivers, scene.readings);
  MotionFitOptions options;
  options.model = cell.model;
  Run run;
  const double begin = thread_seconds();
  const MotionAnswer answer = fit_motion(bearings, options);
  run.seconds = thread_seconds() - begin;
  if (!answer.fit) return run;
  const TargetState& state = answer.fit->state;
  const TargetState truth = truth_at(scene.paths.front(), state.time);
  const auto bound = motion_bound(truth, bearings, cell.model);
  if (!bound) return run;
  Vector9d error;
  error << state.p_world - truth.p_world, state.v_world - truth.v_world, state.a_world - truth.a_world;
  const int unknowns = cell.model == MotionModel::Velocity ? 6 : 9;
  run.is_determined = true;
  run.squared_error_m2 = error.head<3>().squaredNorm();
  run.squared_bound_m2 = bound->topLeftCorner<3, 3>().trace();
  run.chi2 = answer.fit->chi2;
  run.degrees = answer.fit->degrees;
  run.error = error.head(unknowns);
  run.covariance = state.covariance.topLeftCorner(unknowns, unknowns);
  return run;
}

struct CellResult {
  std::size_t determined = 0;
  Ratio to_bound;
  double rms_m = 0.0, bound_m = 0.0, chi2_per_degree = 0.0, fit_us = 0.0;
  ErrorConsistency nees;
};

CellResult result_of(const std::vector<Run>& runs) {
  CellResult result;
  std::vector<double> errors, bounds;
  ErrorConsistencyTally nees;
  double chi2 = 0.0, degrees = 0.0;
  for (const Run& run : runs) {
    result.fit_us += 1e6 * run.seconds / static_cast<double>(runs.size());
    if (!run.is_determined) continue;
    errors.push_back(run.squared_error_m2);
    bounds.push_back(run.squared_bound_m2);
    nees.add(run.error, run.covariance);
    chi2 += run.chi2;
    degrees += run.degrees;
  }
  result.determined = errors.size();
  if (errors.empty()) return result;
  result.to_bound = ratio_of_rms(errors, bounds);
  result.rms_m = pooled_rms(errors);
  result.bound_m = pooled_rms(bounds);
  result.chi2_per_degree = chi2 / degrees;
  result.nees = nees.result();
  return result;
}

std::vector<std::string> row_of(const Cell& cell, const CellResult& r) {
  return {cell.name,
          std::to_string(r.determined),
          fmt::format("{:.4f}", r.rms_m),
          fmt::format("{:.4f}", r.bound_m),
          fmt::format("{:.3f} [{:.3f}, {:.3f}]", r.to_bound.value, r.to_bound.low, r.to_bound.high),
          fmt::format("{:.4f}", r.nees.mean_per_degree),
          fmt::format("[{:.4f}, {:.4f}]", r.nees.lower, r.nees.upper),
          fmt::format("{:.4f}", r.chi2_per_degree),
          fmt::format("{:.1f}", r.fit_us)};
}

nlohmann::json json_of(const CellResult& r) {
  return {{"determined", r.determined},
          {"rms_m", r.rms_m},
          {"bound_m", r.bound_m},
          {"to_bound", {{"value", r.to_bound.value}, {"low", r.to_bound.low}, {"high", r.to_bound.high}}},
          {"nees", {{"mean_per_degree", r.nees.mean_per_degree}, {"lower", r.nees.lower}, {"upper", r.nees.upper}}},
          {"chi2_per_degree", r.chi2_per_degree},
          {"fit_us", r.fit_us}};
}

}  // namespace

ExperimentSection targets_batch(const ExperimentContext& context) {
  ExperimentSection section{
      "batch",
      "The stamped batch against its bound",
      {"One target, five periods, delays .1/.2 unless said; position at the time of the last bearing. "
       "Accelerating: each coordinate of a constant acceleration N(0, 3 m/s²), fitted with it.",
       "RMS ÷ bound (Cramér-Rao): 95 % interval by bootstrap over runs. NEES per degree of freedom, of all unknowns, "
       "beside the 95 % bounds of an honest covariance; chi2 per degree of the bearings' errors."},
      {},
      {},
      {}};
  ReportTable table{
      fmt::format("{} runs of each cell", context.runs),
      {"cell", "determined", "RMS (m)", "bound (m)", "RMS / bound", "NEES", "its bounds", "chi2", "CPU (us)"},
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
      context.progress({"batch", static_cast<std::int64_t>(i + 1), static_cast<std::int64_t>(cells.size()), ""});
    }
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
