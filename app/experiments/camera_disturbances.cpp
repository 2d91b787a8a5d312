// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "app/experiments/camera_comparison.h"
#include "app/experiments/camera_experiment.h"

namespace alidade {

ExperimentSection camera_outliers(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"outliers", "Outliers, against RANSAC", {}, {}, {}, {}};
  for (double share : {0.3, 0.5}) {
    CameraScene scene = base;
    scene.outliers = share;
    const auto ransac = [&](const CameraRun& run) {
      return NamedTrajectories{{"RANSAC-EPnP + LM", estimate_by_ransac(scene.camera, run, scene.sigma_px)}};
    };
    const std::string name = fmt::format("{:.0f}", 100.0 * share);
    const auto errors =
        compare(scene, context, name + " % outliers", {ransac, our_filter(scene, learned_options(scene, context), {})});
    if (context.stop.stop_requested()) return section;
    section.tables.push_back(
        error_table(fmt::format("Path 'smooth', {} % outliers", name), scene, errors, "RANSAC-EPnP + LM"));
    section.summary[name] = summary_of(errors, "RANSAC-EPnP + LM");
    section.summary[name]["time_ratio"] =
        mean(errors.at("ours, causal").seconds) / mean(errors.at("RANSAC-EPnP + LM").seconds);
  }
  return section;
}

ExperimentSection camera_uncertain_map(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"uncertain-map", "A map of two adjacent views", {}, {}, {}, {}};
  CameraScene scene = base;
  scene.sigma_px = 1.0;
  const auto prepare = [&](CameraRun run) {
    return with_map_of_two_views(scene.camera, std::move(run), scene.sigma_px);
  };
  std::vector<CameraRun> unscored = unscored_runs(scene, context, 5);
  for (CameraRun& run : unscored) run = prepare(std::move(run));
  struct Variant {
    std::string name;
    MapUncertainty uncertainty;
    SharedMapError shared;
  };
  const std::vector<Variant> variants{
      {"R inflated", MapUncertainty::Inflated, SharedMapError::Ignored},
      {"points refitted", MapUncertainty::Refitted, SharedMapError::Ignored},
      {"refitted, shared error considered", MapUncertainty::Refitted, SharedMapError::Considered}};
  std::vector<CameraMethod> methods{single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm)};
  for (const Variant& variant : variants) {
    CameraFilterOptions options;
    options.update.map_uncertainty = variant.uncertainty;
    options.motion = guessed_motion(unscored.front().truth);
    options.motion = learn_motion(scene.camera, unscored, options, variant.shared);
    methods.push_back([&scene, variant, options](const CameraRun& run) {
      return NamedTrajectories{{variant.name, causal_poses(filter_run(scene.camera, run, options, variant.shared))}};
    });
  }
  const auto errors = compare(scene, context, "uncertain map", methods, prepare);
  if (context.stop.stop_requested()) return section;
  section.summary = summary_of(errors, "EPnP + LM");
  ReportTable table{"Path 'smooth', map triangulated from the first two frames, sigma 1 px",
                    {"method", "position RMSE (% of path)", "/ EPnP + LM", "rotation / EPnP + LM", "NEES per dof"},
                    {}};
  std::vector<std::string> names{"EPnP + LM"};
  for (const Variant& variant : variants) names.push_back(variant.name);
  for (const std::string& name : names) {
    const MethodErrors& e = errors.at(name);
    const MethodErrors& lm = errors.at("EPnP + LM");
    table.rows.push_back({name, of_path_percent(rms(e.position_m), scene),
                          with_interval(rms_ratio(e.position_m, lm.position_m)),
                          with_interval(rms_ratio(e.rotation_rad, lm.rotation_rad)),
                          e.nees_per_dof.empty() ? "-" : fmt::format("{:.2f}", mean(e.nees_per_dof))});
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
