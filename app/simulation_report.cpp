// SPDX-License-Identifier: Apache-2.0
#include "app/simulation_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "view/plot.h"

namespace alidade {
namespace {

std::vector<std::vector<double>> rows_of(const Eigen::Isometry3d& T) {
  std::vector<std::vector<double>> rows(4, std::vector<double>(4));
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = T.matrix()(r, c);
  }
  return rows;
}

std::vector<Plot> plots_of(const Trajectory& truth) {
  Series above{"", {}, {}, SeriesStyle::Line, palette::kTruth};
  Series height = above;
  for (const auto& pose : truth) {
    const Eigen::Vector3d p = pose.T_world_camera.translation();
    above.x.push_back(p.x());
    above.y.push_back(p.y());
    height.x.push_back(to_seconds(pose.time.time_since_epoch()));
    height.y.push_back(p.z());
  }
  return {{"True path from above", "x (m)", "y (m)", {above}, true, false},
          {"Height of the camera", "time (s)", "z (m)", {height}, false, false}};
}

}  // namespace

nlohmann::json summary_of(const SimulationRecord& record) {
  nlohmann::json summary;
  summary["frames"] = record.truth.size();
  summary["frames_wanted"] = record.options.frames;
  summary["fps_hz"] = record.options.fps_hz;
  summary["width_px"] = record.options.camera.width;
  summary["height_px"] = record.options.camera.height;
  summary["path_length_m"] = path_length(record.truth);
  summary["seed"] = record.options.seed;
  summary["interrupted"] = record.interrupted;
  if (record.T_world_marker) {
    summary["marker"] = {{"dictionary", "APRILTAG_36h11"},
                         {"id", 0},
                         {"side_m", record.options.marker_m},
                         {"T_world_marker", rows_of(*record.T_world_marker)}};
  }
  return summary;
}

Report report_of(const SimulationRecord& record, const std::vector<std::string>& arguments,
                 const std::string& options) {
  Report report;
  report.title = "Simulated camera";
  report.arguments = arguments;
  report.options = options;
  const Camera& camera = record.options.camera;
  report.summary = {
      {"frames", fmt::format("{} of {}", record.truth.size(), record.options.frames), "", Verdict::None, ""},
      {"size", fmt::format("{}x{}", camera.width, camera.height), "px", Verdict::None, ""},
      {"path length", fmt::format("{:.3f}", path_length(record.truth)), "m", Verdict::None, ""},
      {"pixel noise", fmt::format("{:g}", record.options.noise_grey), "grey levels", Verdict::None,
       "standard deviation"},
      {"exposure", fmt::format("{:g}", record.options.exposure_s), "s", Verdict::None, ""}};
  if (record.interrupted) report.warnings.emplace_back("interrupted: the sequence is shorter than wanted");
  ReportSection frames{"Frames", {}, {}, {}};
  for (const auto& frame : record.frames) frames.figures.push_back({frame, "", FigureFormat::Jpeg});
  report.sections = {frames,
                     {"Truth", {}, {}, {{draw_plots(plots_of(record.truth), {960, 420}), "", FigureFormat::Png}}}};
  report.links = {{"truth.tum", "true pose of every frame (TUM)"},
                  {"camera.yaml", "the camera"},
                  {"frames.csv", "time of every frame"}};
  return report;
}

}  // namespace alidade
