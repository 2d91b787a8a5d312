// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "app/experiments/camera_claims.h"
#include "app/experiments/camera_comparison.h"
#include "app/experiments/constant_velocity.h"
#include "tracking/map_offset.h"
#include "tracking/paper_filter.h"

namespace alidade {
namespace {

constexpr double kMapSigmaM = 0.003;  // what two views with 3 px leave of a point at half a metre, across the rays
const std::string kInState = "map in the state";
const std::string kPaper = "paper's filter";
const std::string kOurs = "map's error considered";

CameraRun with_known_map_errors(CameraRun run) {
  std::mt19937_64 random(run.number);
  std::normal_distribution<double> normal(0.0, kMapSigmaM);
  for (std::size_t i = 0; i < run.sightings.front().size(); ++i) {
    const Eigen::Vector3d error(normal(random), normal(random), normal(random));
    for (auto& sightings : run.sightings) {
      sightings[i].p_world += error;
      sightings[i].covariance_world = kMapSigmaM * kMapSigmaM * Eigen::Matrix3d::Identity();
    }
  }
  return run;
}

struct Filter {
  std::string name;
  std::function<Trajectory(const CameraRun&, const MotionNoise&)> run;
};

std::vector<Filter> filters(const Camera& camera) {
  const FrameUpdate paper = [camera](const MotionState& predicted, std::span<const PointObservation> seen) {
    return update_paper_filter(camera, predicted, seen);
  };
  return {{kInState,
           [camera](const CameraRun& run, const MotionNoise& noise) {
             return estimate_with_map_in_state(camera, run, constant_velocity_start(run.truth), noise);
           }},
          {kPaper,
           [paper](const CameraRun& run, const MotionNoise& noise) {
             return estimate_at_constant_velocity(run, constant_velocity_start(run.truth), noise, paper);
           }},
          {kOurs, [ours = iterated_update(camera)](const CameraRun& run, const MotionNoise& noise) {
             MotionState start = constant_velocity_start(run.truth);
             start.map_offset = rigid_offset(run.sightings[2]);
             return estimate_at_constant_velocity(run, start, noise, ours);
           }}};
}

// The noise, times a factor, with which a filter errs least.
MotionNoise best_noise(const Filter& filter, const std::vector<CameraRun>& unscored, const MotionNoise& noise) {
  MotionNoise best;
  double least = std::numeric_limits<double>::infinity();
  for (double factor : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) {
    MotionNoise scaled = noise;
    scaled.acceleration *= factor;
    MethodErrors errors;
    for (const CameraRun& run : unscored) add_run(errors, run, filter.run(run, scaled));
    const double error_m = rms(errors.position_m);
    if (error_m < least) {
      least = error_m;
      best = scaled;
    }
  }
  return best;
}

using Errors = std::map<std::string, MethodErrors>;

// A setting of the comparison and what came of it.
struct Row {
  std::string map;
  std::size_t points;
  int runs;
  int frames;
  Errors errors;

  Ratio accuracy(const std::string& reference) const {
    return rms_ratio(errors.at(kInState).position_m, errors.at(reference).position_m);
  }
  double frame_ms(const std::string& method) const { return 1e3 * mean(errors.at(method).seconds) / (frames - 2); }
  double cost() const { return frame_ms(kInState) / frame_ms(kPaper); }
};

// One update grows with the cube of the points: beyond 100 fewer runs keep the time.
int runs_for(std::size_t points, int runs) {
  const double share = std::min(1.0, 1e4 / static_cast<double>(points * points));
  return std::max(std::min(runs, 5), static_cast<int>(share * runs));
}

using Prepare = std::function<CameraRun(CameraRun)>;

// Each filter with its own noise, tuned on runs that are not scored, with at most 100 points.
std::vector<CameraMethod> tuned_filters(CameraScene scene, const ExperimentContext& context, const Prepare& prepare) {
  scene.points = thinned(scene.points, 100);
  std::vector<CameraRun> unscored = unscored_runs(scene, context, 3);
  const MotionNoise noise = tune_paper_noise(scene.camera, unscored, scene.sigma_px);
  for (CameraRun& run : unscored) run = prepare(std::move(run));
  std::vector<CameraMethod> methods;
  for (const Filter& filter : filters(scene.camera)) {
    methods.push_back([filter, best = best_noise(filter, unscored, noise)](const CameraRun& run) {
      return NamedTrajectories{{filter.name, filter.run(run, best)}};
    });
  }
  return methods;
}

Row measure(CameraScene scene, ExperimentContext context, std::size_t points, const std::string& map) {
  scene.points = thinned(scene.points, points);
  context.runs = runs_for(points, context.runs);
  const Prepare prepare = [&](CameraRun run) {
    run = with_sigma(std::move(run), scene.sigma_px);
    if (map == "known") return with_known_map_errors(std::move(run));
    return with_map_of_two_views(scene.camera, std::move(run), scene.sigma_px);
  };
  Errors errors = compare(scene, context, fmt::format("map in the state, {} points", points),
                          tuned_filters(scene, context, prepare), prepare);
  return {map, scene.points.size(), context.runs, scene.frames, std::move(errors)};
}

std::vector<std::string> cells(const Row& row) {
  const auto mm = [&](const std::string& name) {
    return fmt::format("{:.3f}", 1e3 * rms(row.errors.at(name).position_m));
  };
  return {row.map,
          std::to_string(row.points),
          std::to_string(row.runs),
          mm(kInState),
          mm(kPaper),
          mm(kOurs),
          with_interval(row.accuracy(kPaper)),
          with_interval(row.accuracy(kOurs)),
          fmt::format("{:.2f}", mean(row.errors.at(kInState).nees_per_dof)),
          fmt::format("{:.3f}", row.frame_ms(kInState)),
          fmt::format("{:.3f}", row.frame_ms(kPaper)),
          fmt::format("{:.0f}", row.cost())};
}

}  // namespace

ClaimEvidence map_in_state_claims(const CameraScene& base, const ExperimentContext& context) {
  ClaimEvidence evidence;
  evidence.remarks.push_back(fmt::format(
      "Map in the state: all filters get the same points with the same covariance, the same start and the same "
      "constant-velocity model, each with the motion noise that serves it best (a factor on that of the paper's "
      "filter, "
      "on runs that are not scored). 'known': every point is off by its own Gaussian error of {:.0f} mm per axis, so "
      "that what a filter assumes of the map holds; 'two views': triangulated from the first two frames, sigma 1 px.",
      1e3 * kMapSigmaM));
  std::vector<Row> rows;
  for (std::size_t points : {25u, 50u, 100u, 200u, 400u}) {
    rows.push_back(measure(base, context, points, "known"));
    if (context.stop.stop_requested()) return evidence;
  }
  CameraScene fine = base;
  fine.sigma_px = 1.0;
  rows.push_back(measure(fine, context, 100, "two views"));
  if (context.stop.stop_requested()) return evidence;

  Claim cost{"map_in_state_costs_more", "a filter with the map in its state (13 + 3M) costs more", true, {}};
  Claim accuracy{"map_in_state_is_less_accurate", "a filter with the map in its state is less accurate", true, {}};
  ReportTable table{"Path 'smooth': position RMSE (mm) and CPU time per frame (ms), map in the state and outside",
                    {"map", "M", "runs", kInState, kPaper, kOurs, "in state / paper's", "in state / considered",
                     "NEES per dof in state", "ms in state", "ms paper's", "ratio"},
                    {}};
  for (const Row& row : rows) {
    cost.is_confirmed = cost.is_confirmed && row.cost() > 1.0;
    accuracy.is_confirmed = accuracy.is_confirmed && row.accuracy(kPaper).low > 1.0;
    table.rows.push_back(cells(row));
    cost.figures.push_back({{"map", row.map}, {"points", row.points}, {"time_ratio", row.cost()}});
    accuracy.figures.push_back({{"map", row.map},
                                {"points", row.points},
                                {"position_ratio", as_json(row.accuracy(kPaper))},
                                {"position_ratio_to_considered", as_json(row.accuracy(kOurs))}});
  }
  evidence.claims = {std::move(cost), std::move(accuracy)};
  evidence.tables.push_back(std::move(table));
  return evidence;
}

}  // namespace alidade
