// SPDX-License-Identifier: Apache-2.0
#include "app/targets/simulation_report.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/scene_picture.h"
#include "app/targets/receiver_scene.h"
#include "view/plot.h"

namespace alidade {
namespace {

Eigen::AlignedBox3d box_of(std::span<const TargetRow> truth) {
  Eigen::AlignedBox3d box;
  for (const TargetRow& row : truth) box.extend(row.p_world);
  return box;
}

Series dots(const std::string& name) {
  Series series;
  series.name = name;
  series.style = SeriesStyle::Dots;
  return series;
}

Plot paths_from_above(std::span<const TargetRow> truth) {
  Plot plot{"True paths from above", "x (m)", "y (m)", {}, true, false};
  std::map<int, Series> paths;
  for (const TargetRow& row : truth) {
    Series& path = paths[row.target];
    path.name = fmt::format("target {}", row.target);
    path.x.push_back(row.p_world.x());
    path.y.push_back(row.p_world.y());
  }
  for (auto& [target, path] : paths) plot.series.push_back(std::move(path));
  return plot;
}

// The azimuth of everything that was seen, right or wrong, at its time.
Plot sightings_over_time(const TargetScene& scene) {
  Plot plot{"What the receivers reported", "time (s)", "azimuth (rad)", {}, false, false};
  for (const Receiver& receiver : scene.receivers) {
    Series series = dots(receiver.name);
    for (const ReceiverReading& reading : scene.readings) {
      if (reading.receiver != receiver.id) continue;
      series.x.push_back(to_seconds(reading.time.time_since_epoch()));
      series.y.push_back(reading.value[0]);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::int64_t count_of_false(const TargetScene& scene) {
  return std::count_if(scene.readings.begin(), scene.readings.end(), [](const auto& r) { return r.target < 0; });
}

}  // namespace

std::vector<TargetRow> truth_of(const TargetScene& scene, double rate_hz) {
  Timestamp end{};
  for (const TargetPath& path : scene.paths) end = std::max(end, path.death);
  return truth_of(scene.paths, rate_hz, to_seconds(end.time_since_epoch()));
}

std::vector<TargetRow> truth_of(std::span<const TargetPath> paths, double rate_hz, double duration_s) {
  std::vector<TargetRow> rows;
  for (int i = 0; i < duration_s * rate_hz; ++i) {
    const Timestamp time(from_seconds(i / rate_hz));
    for (const TargetPath& path : paths) {
      if (time < path.birth || time >= path.death) continue;
      rows.push_back({time, path.target, "true", position_at(path, time), velocity_at(path, time)});
    }
  }
  return rows;
}

Scene picture_of(std::span<const Receiver> receivers, std::span<const TargetRow> truth) {
  Scene scene;
  scene.up_world = Eigen::Vector3d::UnitZ();
  add_receivers(receivers, receiver_size_m(receivers, box_of(truth)), scene);
  std::map<int, ScenePath> paths;
  for (const TargetRow& row : truth) paths[row.target].points_world.push_back(row.p_world);
  for (auto& [target, path] : paths) {
    path.colour = palette::kReference;
    scene.paths.push_back(std::move(path));
  }
  scene.legend.push_back({"true paths", palette::kReference, PyramidStyle::Solid});
  return scene;
}

nlohmann::json summary_of(const TargetSceneOptions& options, const TargetScene& scene) {
  return {{"targets", options.targets},
          {"receivers", options.receivers},
          {"periods", options.periods},
          {"period_s", options.period_s},
          {"range_m", scene.range_m},
          {"sigma_rad", scene.receivers.front().sigma},
          {"detection_probability", options.detection_probability},
          {"bearings", scene.readings.size()},
          {"false_bearings", count_of_false(scene)},
          {"truth", "truth.csv"},
          {"seed", options.seed}};
}

Report report_of(const TargetSceneOptions& options, const TargetScene& scene, std::span<const TargetRow> truth,
                 const std::vector<std::string>& arguments) {
  Report report;
  report.title = "Simulated targets";
  report.arguments = arguments;
  report.summary = {{"targets", fmt::format("{}", options.targets), "", Verdict::None, ""},
                    {"receivers", fmt::format("{}", options.receivers), "", Verdict::None, ""},
                    {"scans", fmt::format("{}", options.periods), "", Verdict::None, ""},
                    {"range", fmt::format("{:.1f}", scene.range_m), "m", Verdict::None, "of the receivers"},
                    {"noise", fmt::format("{:.3f}", 1e3 * scene.receivers.front().sigma), "mrad", Verdict::None,
                     "standard deviation across the line of sight"},
                    {"bearings", fmt::format("{}", scene.readings.size()), "", Verdict::None, ""},
                    {"false ones", fmt::format("{}", count_of_false(scene)), "", Verdict::None, "among them"}};
  ReportSection section{"Truth", {}, {}, {}};
  if (const auto image =
          draw_scene(picture_of(scene.receivers, truth), {0.9, 0.5, 1.0}, "the scene", report.warnings)) {
    section.figures.push_back({*image, "", FigureFormat::Png});
  }
  const std::vector<Plot> plots{paths_from_above(truth), sightings_over_time(scene)};
  section.figures.push_back({draw_plots(plots, {960, 420}), "", FigureFormat::Png});
  report.sections.push_back(std::move(section));
  report.links = {
      {"receivers.yaml", "the receivers"}, {"observations.csv", "what they reported"}, {"truth.csv", "the true paths"}};
  return report;
}

nlohmann::json summary_of(const SkySceneOptions& options, const SkyScene& scene,
                          const std::vector<std::string>& videos) {
  return {{"targets", scene.paths.size()},
          {"receivers", scene.receivers.size()},
          {"duration_s", options.duration_s},
          {"videos", videos},
          {"truth", "truth.csv"},
          {"seed", options.seed}};
}

Report report_of(const SkyScene& scene, std::span<const TargetRow> truth, const std::vector<std::string>& videos,
                 const std::vector<std::string>& arguments) {
  Report report;
  report.title = "Filmed targets";
  report.arguments = arguments;
  report.summary = {{"targets", fmt::format("{}", scene.paths.size()), "", Verdict::None, ""},
                    {"cameras", fmt::format("{}", scene.receivers.size()), "", Verdict::None, ""},
                    {"duration", fmt::format("{:g}", scene.duration_s), "s", Verdict::None, ""}};
  ReportSection section{"Truth", {}, {}, {}};
  if (const auto image =
          draw_scene(picture_of(scene.receivers, truth), {0.9, 0.5, 1.0}, "the scene", report.warnings)) {
    section.figures.push_back({*image, "", FigureFormat::Png});
  }
  section.figures.push_back({draw_plot(paths_from_above(truth), {960, 420}), "", FigureFormat::Png});
  if (const auto frame = SkyVideo(scene, 0).next()) {
    section.figures.push_back({frame->image, "the first frame of " + videos.front(), FigureFormat::Png});
  }
  report.sections.push_back(std::move(section));
  report.links = {{"receivers.yaml", "the cameras"},
                  {"truth.csv", "the true paths"},
                  {"truth_pixels.csv", "where they truly are in the frames"}};
  for (const std::string& video : videos) report.links.push_back({video, "lossless video"});
  return report;
}

}  // namespace alidade
