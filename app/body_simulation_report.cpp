// SPDX-License-Identifier: Apache-2.0
#include "app/body_simulation_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "view/plot.h"

namespace alidade {
namespace {

constexpr int kDrawn = 2000;  // frames; more than a plot has pixels across

double share_of_wrong(const BodySimulationRecord& record) {
  return record.readings == 0 ? 0.0 : static_cast<double>(record.wrong_ids) / static_cast<double>(record.readings);
}

Series line(const std::string& name) {
  Series series;
  series.name = name;
  return series;
}

std::vector<Plot> plots_of(const BodySimulationRecord& record) {
  Plot above{"True paths from above", "x (m)", "y (m)", {}, true, false};
  Plot height{"Height of the bodies", "time (s)", "z (m)", {}, false, false};
  Plot seen{"Readings per frame", "time (s)", "readings", {line("")}, false, false};
  seen.series[0].y = record.readings_per_frame;
  for (std::size_t i = 0; i < record.truth.size(); ++i) {
    const std::string name = record.truth.size() > 1 ? record.body_names[i] : "";
    Series from_above = line(name), over_time = line(name);
    for (const StampedPose& pose : record.truth[i]) {
      const Eigen::Vector3d p = pose.T_world_camera.translation();
      from_above.x.push_back(p.x());
      from_above.y.push_back(p.y());
      over_time.x.push_back(to_seconds(pose.time.time_since_epoch()));
      over_time.y.push_back(p.z());
    }
    if (i == 0) seen.series[0].x = over_time.x;
    above.series.push_back(std::move(from_above));
    height.series.push_back(std::move(over_time));
  }
  return {above, height, seen};
}

}  // namespace

void BodySimulationRecord::add(const BodySceneFrame& frame, const std::vector<Eigen::Isometry3d>& T_world_body) {
  readings += static_cast<std::int64_t>(frame.readings.size());
  wrong_ids += std::count(frame.is_right.begin(), frame.is_right.end(), false);
  if (frames++ % std::max(1, options.frames / kDrawn) != 0) return;
  truth.resize(T_world_body.size());
  for (std::size_t i = 0; i < truth.size(); ++i) truth[i].push_back({frame.time, T_world_body[i], std::nullopt});
  readings_per_frame.push_back(static_cast<double>(frame.readings.size()));
}

nlohmann::json summary_of(const BodySimulationRecord& record) {
  const BodySceneOptions& options = record.options;
  return {{"frames", record.frames},
          {"frames_wanted", options.frames},
          {"rate_hz", options.rate_hz},
          {"bodies", options.bodies},
          {"markers_per_body", options.markers},
          {"detectors", 4 * options.blocks},
          {options.has_lenses ? "sigma_px" : "sigma_rad", options.has_lenses ? options.sigma_px : options.sigma_rad},
          {"line_images", !record.line_image.empty()},
          {"readings", record.readings},
          {"readings_with_wrong_id", record.wrong_ids},
          {"truth", record.truth_files},
          {"seed", options.seed},
          {"interrupted", record.interrupted}};
}

Report report_of(const BodySimulationRecord& record, const std::vector<std::string>& arguments,
                 const std::string& options) {
  Report report;
  report.title = "Simulated bodies";
  report.arguments = arguments;
  report.options = options;
  const BodySceneOptions& scene = record.options;
  report.summary = {
      {"frames", fmt::format("{} of {}", record.frames, scene.frames), "", Verdict::None, ""},
      {"rate", fmt::format("{:g}", scene.rate_hz), "Hz", Verdict::None, ""},
      {"bodies", fmt::format("{} of {} markers", scene.bodies, scene.markers), "", Verdict::None, ""},
      {"detectors", fmt::format("{} in {} blocks", 4 * scene.blocks, scene.blocks), "", Verdict::None, ""},
      {"readings", fmt::format("{}", record.readings), "", Verdict::None, ""},
      {"named after a wrong marker", fmt::format("{:.2f}", 100 * share_of_wrong(record)), "%", Verdict::None, ""},
      {"noise", fmt::format("{:.4g}", scene.has_lenses ? scene.sigma_px : 1e3 * scene.sigma_rad),
       scene.has_lenses ? "px" : "mrad", Verdict::None, "standard deviation of a reading"}};
  if (record.interrupted) report.warnings.emplace_back("interrupted: the sequence is shorter than wanted");
  report.sections = {{"Truth", {}, {}, {{draw_plots(plots_of(record), {960, 420}), "", FigureFormat::Png}}}};
  report.links = {{"body.csv", "the bodies' markers"},
                  {"detectors.yaml", "the detectors and where they stand"},
                  {"observations.csv", "what they read"}};
  if (!record.line_image.empty()) {
    constexpr int kShownRows = 128;
    const cv::Mat first = record.line_image.rowRange(0, std::min(kShownRows, record.line_image.rows));
    report.sections.push_back({"Line images",
                               {"The first rows of the first detector, one below the other in order of time. "
                                "Observations are of lit markers, with the noise of the Cramér–Rao bound of a spot."},
                               {},
                               {{first, "", FigureFormat::Png}}});
    report.links.push_back({"line_images", "what all detectors recorded"});
  }
  for (const std::string& file : record.truth_files) report.links.push_back({file, "true pose of every frame (TUM)"});
  return report;
}

}  // namespace alidade
