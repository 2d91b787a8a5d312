// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "app/experiments/camera_comparison.h"
#include "app/experiments/camera_experiment.h"

namespace alidade {

ExperimentSection camera_noise(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"noise", "Error by pixel noise (the paper's Fig. 5)", {}, {}, {}, {}};
  ReportTable table{"Path 'smooth': position RMSE (% of path) and its ratio to EPnP + LM, rotation ratio",
                    {"sigma (px)", "EPnP", "EPnP + LM", "ours, causal", "position ratio", "rotation ratio"},
                    {}};
  Plot plot{"Path 'smooth'", "sigma (px)", "position RMSE (% of path)", {}, false, false};
  for (const char* method : {"EPnP", "EPnP + LM", "ours, causal"})
    plot.series.push_back({method, {}, {}, SeriesStyle::Line, std::nullopt});
  for (double sigma_px : {0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0}) {
    CameraScene scene = base;
    scene.sigma_px = sigma_px;
    const auto errors =
        compare(scene, context, fmt::format("noise, {} px", sigma_px),
                {single_frames(scene, "EPnP", PnpMethod::Epnp), single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm),
                 our_filter(scene, learned_options(scene, context), {})});
    if (context.stop.stop_requested()) return section;
    const double path_m = path_length(simulate_run(scene, 0).truth);
    std::vector<std::string> row{fmt::format("{}", sigma_px)};
    for (Series& series : plot.series) {
      const double percent = 100.0 * rms(errors.at(series.name).position_m) / path_m;
      series.x.push_back(sigma_px);
      series.y.push_back(percent);
      row.push_back(fmt::format("{:.3g}", percent));
    }
    const nlohmann::json summary = summary_of(errors, "EPnP + LM");
    nlohmann::json ours = summary["ours, causal"];
    ours["sigma_px"] = sigma_px;
    ours["of_path_percent"] = plot.series.back().y.back();
    section.summary.push_back(ours);
    for (const char* ratio : {"position_ratio", "rotation_ratio"}) {
      row.push_back(fmt::format("{:.3f}", ours[ratio]["value"].get<double>()));
    }
    table.rows.push_back(std::move(row));
  }
  section.tables.push_back(std::move(table));
  section.figures.push_back({"noise.png", "Error against pixel noise; the filter is not told it.", {plot}});
  return section;
}

ExperimentSection camera_frames(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{
      "frames", "The same path in more frames", {"A lag of 12 frames of 220 is the same time as 3 of 55."}, {}, {}, {}};
  for (int frames : {110, 220}) {
    CameraScene scene = base;
    scene.frames = frames;
    const auto errors = compare(scene, context, fmt::format("{} frames", frames),
                                {single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm),
                                 our_filter(scene, learned_options(scene, context), {3, 12})});
    if (context.stop.stop_requested()) return section;
    section.tables.push_back(
        error_table(fmt::format("Path 'smooth' in {} frames", frames), scene, errors, "EPnP + LM"));
    section.summary[std::to_string(frames)] = summary_of(errors, "EPnP + LM");
  }
  return section;
}

ExperimentSection camera_points(const CameraScene& base, const ExperimentContext& context) {
  ExperimentSection section{"points", "Fewer points", {}, {}, {}, {}};
  ReportTable table{"Path 'smooth', sigma 3 px: position RMSE (mm)",
                    {"points", "EPnP", "EPnP + LM", "ours, causal", "ratio to EPnP + LM"},
                    {}};
  for (std::size_t count : {10u, 20u, 50u, 100u, 200u}) {
    CameraScene scene = base;
    scene.points = thinned(base.points, count);
    const auto errors =
        compare(scene, context, fmt::format("{} points", count),
                {single_frames(scene, "EPnP", PnpMethod::Epnp), single_frames(scene, "EPnP + LM", PnpMethod::EpnpLm),
                 our_filter(scene, learned_options(scene, context), {})});
    if (context.stop.stop_requested()) return section;
    std::vector<std::string> row{std::to_string(scene.points.size())};
    for (const char* name : {"EPnP", "EPnP + LM", "ours, causal"}) {
      row.push_back(fmt::format("{:.3f}", 1e3 * rms(errors.at(name).position_m)));
    }
    row.push_back(with_interval(rms_ratio(errors.at("ours, causal").position_m, errors.at("EPnP + LM").position_m)));
    table.rows.push_back(std::move(row));
    section.summary[std::to_string(scene.points.size())] = summary_of(errors, "EPnP + LM");
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
