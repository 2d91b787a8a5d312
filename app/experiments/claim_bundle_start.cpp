// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/experiments/camera_claims.h"
#include "app/experiments/camera_comparison.h"
#include "reconstruction/bundle_adjustment.h"
#include "reconstruction/map_point.h"

namespace alidade {
namespace {

constexpr std::size_t kPoints = 100;
constexpr int kMostIterations = 200;
const std::string kEpnp = "EPnP";
const std::string kPaper = "paper's filter";
const std::string kOurs = "ours";

using Prepare = std::function<CameraRun(CameraRun)>;

PointMap map_from(const Camera& camera, const CameraRun& run, const Trajectory& estimate, double sigma_px) {
  PointMap map;
  for (std::size_t k = 0; k < run.truth.size(); ++k) {
    Keyframe keyframe;
    keyframe.T_world_camera = (k < 2 ? run.truth[k] : estimate[k - 2]).T_world_camera;
    for (const PointObservation& o : run.sightings[k]) {
      keyframe.sightings.push_back({static_cast<int>(keyframe.sightings.size()), o.pixel, sigma_px});
    }
    map.keyframes.push_back(std::move(keyframe));
  }
  MapPointOptions any;
  any.gate_chi2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < run.sightings.front().size(); ++i) {
    std::vector<PosedSighting> views;
    for (const Keyframe& k : map.keyframes) {
      views.push_back({k.T_world_camera, Matrix6d::Zero(), k.sightings[i].pixel, sigma_px});
    }
    const auto point = triangulate(camera, views, any);
    MapPoint in_map;
    in_map.p_world = point ? point->p_world : run.sightings.front()[i].p_world;
    map.points.push_back(in_map);
  }
  return map;
}

double position_rms(const PointMap& map, const Trajectory& truth) {
  double sum = 0.0;
  for (std::size_t k = 2; k < truth.size(); ++k) {
    sum += (map.keyframes[k].T_world_camera.translation() - truth[k].T_world_camera.translation()).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.size() - 2));
}

struct Adjustment {
  double start_m = 0, end_m = 0, iterations = 0, seconds = 0, rms_px = 0;
};
using Adjustments = std::map<std::string, std::vector<Adjustment>>;  // by start; one per run

Adjustment adjust(const Camera& camera, const CameraRun& run, const Trajectory& estimate, double sigma_px) {
  const PointMap start = map_from(camera, run, estimate, sigma_px);
  BundleOptions options = global_bundle_options(start, 2);
  options.max_iterations = kMostIterations;
  const BundleResult result = adjust_bundle(camera, start, options);
  return {position_rms(start, run.truth), position_rms(result.map, run.truth), static_cast<double>(result.iterations),
          result.seconds, result.rms_px_after};
}

std::vector<CameraMethod> starts(const CameraScene& scene, const ExperimentContext& context, const Prepare& prepare) {
  std::vector<CameraRun> unscored = unscored_runs(scene, context, 3);
  const MotionNoise noise = tune_paper_noise(scene.camera, unscored, scene.sigma_px);
  for (CameraRun& run : unscored) run = prepare(std::move(run));
  CameraFilterOptions options;
  options.update.map_uncertainty = MapUncertainty::Refitted;
  options.motion = guessed_motion(unscored.front().truth);
  options.motion = learn_motion(scene.camera, unscored, options, SharedMapError::Considered);
  return {single_frames(scene, kEpnp, PnpMethod::Epnp),
          [scene, noise](const CameraRun& run) {
            return NamedTrajectories{{kPaper, estimate_by_paper_filter(scene.camera, run, noise, scene.sigma_px)}};
          },
          [scene, options](const CameraRun& run) {
            return NamedTrajectories{
                {kOurs, causal_poses(filter_run(scene.camera, run, options, SharedMapError::Considered))}};
          }};
}

Adjustments adjust_all(const CameraScene& scene, const ExperimentContext& context, const Prepare& prepare) {
  const std::vector<CameraMethod> methods = starts(scene, context, prepare);
  std::vector<std::map<std::string, Adjustment>> outcomes(static_cast<std::size_t>(context.runs));
  std::mutex mutex;
  int done = 0;
  tbb::parallel_for(0, context.runs, [&](int i) {
    if (context.stop.stop_requested()) return;
    const CameraRun run = prepare(simulate_run(scene, context.seed * 1000 + static_cast<unsigned>(i)));
    for (const CameraMethod& method : methods) {
      for (const auto& [name, estimate] : method(run)) {
        outcomes[static_cast<std::size_t>(i)][name] = adjust(scene.camera, run, estimate, scene.sigma_px);
      }
    }
    const std::scoped_lock lock(mutex);
    if (context.progress) context.progress({"bundle adjustment", ++done, context.runs, ""});
  });
  Adjustments adjustments;
  for (const auto& outcome : outcomes) {
    for (const auto& [name, adjustment] : outcome) adjustments[name].push_back(adjustment);
  }
  return adjustments;
}

// Root mean squares over the runs, in proportion to those from EPnP's start.
Ratio ratio_to_epnp(const Adjustments& adjustments, const std::string& name, double Adjustment::*figure) {
  const auto squares = [&](const std::string& of) {
    std::vector<double> result;
    result.reserve(adjustments.at(of).size());
    for (const Adjustment& a : adjustments.at(of)) result.push_back(a.*figure * a.*figure);
    return result;
  };
  return ratio_of_rms(squares(name), squares(kEpnp));
}

double mean_of(const std::vector<Adjustment>& adjustments, double Adjustment::*figure) {
  std::vector<double> values;
  for (const Adjustment& a : adjustments) values.push_back(a.*figure);
  return mean(values);
}

std::vector<std::string> cells(const Adjustments& adjustments, const std::string& name) {
  const auto& of = adjustments.at(name);
  return {name,
          fmt::format("{:.2f}", 1e3 * mean_of(of, &Adjustment::start_m)),
          fmt::format("{:.1f}", mean_of(of, &Adjustment::iterations)),
          with_interval(ratio_to_epnp(adjustments, name, &Adjustment::iterations)),
          fmt::format("{:.0f}", 1e3 * mean_of(of, &Adjustment::seconds)),
          fmt::format("{:.4f}", mean_of(of, &Adjustment::rms_px)),
          with_interval(ratio_to_epnp(adjustments, name, &Adjustment::rms_px)),
          fmt::format("{:.2f}", 1e3 * mean_of(of, &Adjustment::end_m)),
          with_interval(ratio_to_epnp(adjustments, name, &Adjustment::end_m))};
}

// The start must be better, and then end sooner (iterations) or better (residuals).
Claim judged(const Adjustments& adjustments, const std::string& name, Claim claim) {
  const Ratio start = ratio_to_epnp(adjustments, name, &Adjustment::start_m);
  const Ratio iterations = ratio_to_epnp(adjustments, name, &Adjustment::iterations);
  const Ratio rms_px = ratio_to_epnp(adjustments, name, &Adjustment::rms_px);
  claim.is_confirmed = start.high < 1.0 && (iterations.high < 1.0 || rms_px.high < 1.0);
  claim.figures = {{"start_to_epnp", as_json(start)},
                   {"iterations_to_epnp", as_json(iterations)},
                   {"seconds_to_epnp", as_json(ratio_to_epnp(adjustments, name, &Adjustment::seconds))},
                   {"residuals_to_epnp", as_json(rms_px)},
                   {"end_to_epnp", as_json(ratio_to_epnp(adjustments, name, &Adjustment::end_m))}};
  return claim;
}

}  // namespace

ClaimEvidence bundle_start_claims(const CameraScene& base, const ExperimentContext& context) {
  CameraScene scene = base;
  scene.sigma_px = 1.0;
  scene.points = thinned(scene.points, kPoints);
  const Prepare prepare = [&](CameraRun run) {
    return with_map_of_two_views(scene.camera, std::move(run), scene.sigma_px);
  };
  const Adjustments adjustments = adjust_all(scene, context, prepare);
  ClaimEvidence evidence;
  if (context.stop.stop_requested()) return evidence;
  evidence.remarks.push_back(
      fmt::format("Bundle adjustment: {} points, map triangulated from the first two frames; poses by each method in "
                  "that map, then "
                  "all points triangulated anew from all poses. The first two poses are held; at most {} iterations.",
                  kPoints, kMostIterations));
  ReportTable table{"Path 'smooth', sigma 1 px: bundle adjustment from three starts",
                    {"start", "its RMSE (mm)", "iterations", "/ EPnP", "ms", "RMS residual (px)", "/ EPnP",
                     "final RMSE (mm)", "/ EPnP"},
                    {}};
  for (const std::string& name : {kEpnp, kPaper, kOurs}) table.rows.push_back(cells(adjustments, name));
  evidence.claims.push_back(judged(adjustments, kPaper,
                                   {"paper_start_helps_bundle_adjustment",
                                    "from the paper's filter bundle adjustment ends better or sooner than from EPnP",
                                    false,
                                    {}}));
  evidence.claims.push_back(judged(adjustments, kOurs,
                                   {"better_start_helps_bundle_adjustment",
                                    "from a better start still (ours) it ends better or sooner",
                                    false,
                                    {}}));
  evidence.tables.push_back(std::move(table));
  return evidence;
}

}  // namespace alidade
