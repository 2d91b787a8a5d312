// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "app/experiments/camera_comparison.h"
#include "app/experiments/camera_experiment.h"

namespace alidade {
namespace {

std::vector<double> in_degrees(std::vector<double> radians) {
  for (double& r : radians) r *= 180.0 / std::numbers::pi;
  return radians;
}

std::vector<double> scaled_by(std::vector<double> values, double factor) {
  for (double& v : values) v *= factor;
  return values;
}

Series series_over_frames(const std::string& name, std::vector<double> values, SeriesStyle style = SeriesStyle::Line) {
  Series series{name, {}, std::move(values), style, std::nullopt};
  for (std::size_t k = 0; k < series.y.size(); ++k) series.x.push_back(static_cast<double>(k + 3));
  return series;
}

const std::map<OrbitPath, std::string> kPathNames{
    {OrbitPath::Smooth, "smooth"}, {OrbitPath::Turn, "turn"}, {OrbitPath::StopAndGo, "stop-and-go"}};

}  // namespace

ExperimentSection camera_accuracy(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"accuracy", "Error by frame (the paper's Fig. 3 and 4)", {}, {}, {}, {}};
  for (const auto& [path, name] : kPathNames) {
    CameraScene scene = base;
    scene.path = path;
    const std::vector<CameraRun> unscored = unscored_runs(scene, context, 3);
    const MotionNoise paper = tune_paper_noise(scene.camera, unscored, scene.sigma_px);
    const auto paper_filter = [&](const CameraRun& run) {
      return NamedTrajectories{{"paper's filter", estimate_by_paper_filter(scene.camera, run, paper, scene.sigma_px)}};
    };
    const auto errors =
        compare(scene, context, "accuracy, " + name,
                {single_frames(scene, "EPnP", PnpMethod::Epnp), single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm),
                 single_frames(scene, "SQPnP", PnpMethod::Sqpnp), paper_filter,
                 our_filter(scene, learned_options(scene, context), {3})});
    if (context.stop.stop_requested()) return section;
    const FrameBounds bounds = single_frame_bounds(scene);
    ReportTable table = error_table(fmt::format("Path '{}', sigma {} px, {} frames, {} points, {} runs", name,
                                                scene.sigma_px, scene.frames, scene.points.size(), context.runs),
                                    scene, errors, "EPnP + LM");
    section.summary[name] = summary_of(errors, "EPnP + LM");
    table.columns.push_back("frames <= EPnP (%)");
    for (auto& row : table.rows) {
      const double share = frames_not_worse_percent(errors.at(row.front()), errors.at("EPnP"));
      row.push_back(fmt::format("{:.1f}", share));
      section.summary[name][row.front()]["frames_not_worse_than_epnp_percent"] = share;
    }
    section.tables.push_back(std::move(table));
    const double path_m = path_length(simulate_run(scene, 0).truth);
    Plot position{"Path '" + name + "': position", "frame", "mean error (% of path)", {}, false, false};
    Plot rotation{"Path '" + name + "': rotation", "frame", "mean error (deg)", {}, false, false};
    for (const std::string method :
         {"EPnP", "EPnP + LM", "paper's filter", "ours, causal", "ours, lag 3", "ours, smoothed"}) {
      const MethodErrors& e = errors.at(method);
      position.series.push_back(series_over_frames(method, scaled_by(mean_by_frame(e.position_m), 100.0 / path_m)));
      rotation.series.push_back(series_over_frames(method, in_degrees(mean_by_frame(e.rotation_rad))));
    }
    // The bound is on the root mean square; of the mean, a three-dimensional Gaussian error has 0.92.
    const double kMeanOfRms = std::sqrt(8.0 / (3.0 * std::numbers::pi));
    position.series.push_back(series_over_frames(
        "single-frame bound", scaled_by(bounds.position_m, 100.0 * kMeanOfRms / path_m), SeriesStyle::Dashed));
    rotation.series.push_back(series_over_frames(
        "single-frame bound", in_degrees(scaled_by(bounds.rotation_rad, kMeanOfRms)), SeriesStyle::Dashed));
    section.figures.push_back({"accuracy_" + name + ".png",
                               "Mean error of " + std::to_string(context.runs) + " runs in each frame.",
                               {position, rotation}});
  }
  return section;
}

}  // namespace alidade
