// SPDX-License-Identifier: Apache-2.0
#include "app/track_record.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/scene_picture.h"
#include "io/camera_file.h"
#include "io/colmap_model.h"
#include "io/image_files.h"
#include "io/map_file.h"
#include "io/trajectory_file.h"
#include "view/plot.h"
#include "view/report.h"
#include "view/scene.h"

namespace alidade {
namespace {

std::string csv_text(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string frames_csv(const std::vector<FrameReport>& reports) {
  std::string csv = "index,t_ns,image,state,keyframe,inliers,chi2_per_dof,sigma_px,reason\n";
  for (const FrameReport& r : reports) {
    csv += fmt::format("{},{},{},{},{},{},{:.4f},{:.4f},{}\n", r.index, r.time.time_since_epoch().count(),
                       csv_text(r.name), to_string(r.state), r.is_keyframe ? 1 : 0, r.inlier_count, r.chi2_per_dof,
                       r.sigma_px, csv_text(r.reason));
  }
  return csv;
}

std::vector<Plot> plots_of(const TrackRecord& record) {
  Series inliers{"map points found", {}, {}, SeriesStyle::Line, {}};
  Series sigma{"position", {}, {}, SeriesStyle::Line, {}};
  Series x{"x", {}, {}, SeriesStyle::Line, {}}, y{"y", {}, {}, SeriesStyle::Line, {}};
  Series z{"z", {}, {}, SeriesStyle::Line, {}};
  for (const FrameReport& r : record.reports) {
    inliers.x.push_back(r.index);
    inliers.y.push_back(static_cast<double>(r.inlier_count));
    if (!r.has_pose()) continue;
    const Eigen::Vector3d centre = r.T_world_camera.translation();
    for (auto [series, value] : {std::pair{&x, centre.x()}, std::pair{&y, centre.y()}, std::pair{&z, centre.z()}}) {
      series->x.push_back(r.index);
      series->y.push_back(value);
    }
    sigma.x.push_back(r.index);
    sigma.y.push_back(std::sqrt(r.covariance.topLeftCorner<3, 3>().trace()));
  }
  const std::string unit = record.scale.empty() ? "map units" : "m";
  return {{"Camera centre", "frame", unit, {x, y, z}},
          {"Standard deviation of the centre", "frame", unit, {sigma}, false, true},
          {"Map points used", "frame", "points", {inliers}}};
}

std::optional<cv::Mat> draw_track(TrackRecord& record) {
  TrackPicture picture;
  picture.map.points = record.map.points;
  picture.estimate = trajectory_of(record.reports);
  picture.camera = record.camera;
  if (picture.estimate.empty()) return std::nullopt;
  return draw_scene(track_scene(picture), {}, "the scene", record.warnings);
}

Report report_of(const TrackRecord& record, const std::optional<cv::Mat>& scene, const cv::Mat& plots) {
  Report report;
  report.title = "Camera track of " + record.source;
  report.summary = rows_of(table_lines(record));
  report.warnings = record.warnings;
  if (scene) report.sections.push_back({"Map, path and cameras", {}, {}, {{*scene, "", FigureFormat::Png}}});
  report.sections.push_back({"Frame by frame", {}, {}, {{plots, "", FigureFormat::Png}}});
  ReportSection overlays{"Frames", {}, {}, {}};
  for (const OverlaySample& sample : record.overlays) {
    overlays.figures.push_back({sample.picture, fmt::format("frame {}", sample.frame), FigureFormat::Jpeg});
  }
  if (!overlays.figures.empty()) report.sections.push_back(overlays);
  report.links = {{"trajectory.tum", "poses of all frames (TUM)"},
                  {"covariance.csv", "their covariances"},
                  {"frames.csv", "what happened at each frame"},
                  {"map.ply", "points with covariances and descriptors"},
                  {"colmap/images.txt", "the COLMAP text model"}};
  return report;
}

}  // namespace

Trajectory trajectory_of(const std::vector<FrameReport>& reports) {
  Trajectory trajectory;
  for (const FrameReport& r : reports) {
    if (r.has_pose()) trajectory.push_back({r.time, r.T_world_camera, r.covariance});
  }
  return trajectory;
}

int count(const std::vector<FrameReport>& reports, FrameState state) {
  return static_cast<int>(
      std::count_if(reports.begin(), reports.end(), [state](const FrameReport& r) { return r.state == state; }));
}

double latency_quantile(const LiveTally& tally, double share) {
  std::vector<float> latencies = tally.latencies_s;
  if (latencies.empty()) return 0.0;
  const auto place = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(latencies.size() - 1)));
  std::nth_element(latencies.begin(), latencies.begin() + place, latencies.end());
  return static_cast<double>(latencies[static_cast<std::size_t>(place)]);
}

nlohmann::json summary_of(const TrackRecord& record) {
  nlohmann::json summary;
  summary["source"] = record.source;
  summary["times"] =
      record.has_times ? "of the data" : "one second per frame: the data has none, and no --fps was given";
  summary["unit_of_length"] = record.scale.empty() ? "free: one camera alone does not know it" : "m, " + record.scale;
  summary["frames"] = record.reports.size();
  for (const FrameState state : {FrameState::Tracked, FrameState::Predicted, FrameState::Waiting, FrameState::Lost}) {
    summary[std::string("frames_") + to_string(state)] = count(record.reports, state);
  }
  summary["keyframes"] = record.map.keyframes.size();
  summary["points"] = record.map.points.size();
  summary["path_length"] = path_length(trajectory_of(record.reports));
  summary["tracking_s"] = record.tracking_s;
  summary["frames_per_s"] =
      record.tracking_s > 0 ? static_cast<double>(record.reports.size()) / record.tracking_s : 0.0;
  summary["interrupted"] = record.interrupted;
  summary["warnings"] = record.warnings;
  if (const auto& live = record.live) {
    summary["live"] = {{"dropped_by_camera", live->dropped},
                       {"discarded", live->discarded},
                       {"latency_p50_s", latency_quantile(*live, 0.5)},
                       {"latency_p99_s", latency_quantile(*live, 0.99)},
                       {"latency_max_s", latency_quantile(*live, 1.0)}};
  }
  if (const auto& refinement = record.refinement) {
    summary["refinement"] = {{"rms_px_before", refinement->rms_px_before},
                             {"rms_px_after", refinement->rms_px_after},
                             {"sightings", refinement->sightings},
                             {"sightings_added", refinement->sightings_added},
                             {"sightings_aligned", refinement->sightings_aligned},
                             {"sightings_removed", refinement->sightings_removed},
                             {"iterations", refinement->iterations},
                             {"seconds", refinement->seconds},
                             {"focal_factor", refinement->focal_factor},
                             {"focal_factor_sigma", refinement->focal_factor_sigma}};
  }
  return summary;
}

std::vector<std::string> table_lines(const TrackRecord& record) {
  const auto& reports = record.reports;
  std::vector<std::string> lines;
  lines.push_back(fmt::format("frames: {} tracked, {} predicted, {} waiting, {} lost, of {}",
                              count(reports, FrameState::Tracked), count(reports, FrameState::Predicted),
                              count(reports, FrameState::Waiting), count(reports, FrameState::Lost), reports.size()));
  lines.push_back(
      fmt::format("map: {} points from {} keyframes", record.map.points.size(), record.map.keyframes.size()));
  lines.push_back(fmt::format("path length: {:.4g} {}", path_length(trajectory_of(reports)),
                              record.scale.empty() ? "(unit free: see --scale)" : "m (" + record.scale + ")"));
  if (const auto& refinement = record.refinement) {
    lines.push_back(fmt::format("refinement: reprojection {:.3f} -> {:.3f} px RMS over {} sightings in {:.1f} s",
                                refinement->rms_px_before, refinement->rms_px_after, refinement->sightings,
                                refinement->seconds));
  }
  if (const auto& live = record.live) {
    lines.push_back(
        fmt::format("live: {} frames dropped by the camera, {} discarded; exposure to pose {:.1f} ms "
                    "(median), {:.1f} ms (99 %), {:.1f} ms (longest)",
                    live->dropped, live->discarded, 1e3 * latency_quantile(*live, 0.5),
                    1e3 * latency_quantile(*live, 0.99), 1e3 * latency_quantile(*live, 1.0)));
    return lines;
  }
  lines.push_back(fmt::format("speed: {:.1f} frames/s",
                              record.tracking_s > 0 ? static_cast<double>(reports.size()) / record.tracking_s : 0.0));
  return lines;
}

void write_track(TrackRecord& record, const ResultDirectory& directory, const std::vector<std::string>& arguments,
                 const std::string& options_yaml) {
  const Trajectory trajectory = trajectory_of(record.reports);
  write_trajectory_tum(directory.path("trajectory.tum"), trajectory);
  write_covariances(directory.path("covariance.csv"), trajectory);
  directory.write_text("frames.csv", frames_csv(record.reports));
  directory.write_text("options.yaml", options_yaml);
  write_camera(directory.path("camera.yaml"), record.camera);
  write_map_ply(directory.path("map.ply"), record.map);
  std::filesystem::create_directories(directory.path("colmap"));
  write_colmap_model(directory.path("colmap"), record.camera, record.map);
  const auto scene = draw_track(record);
  if (scene) write_image(directory.path("scene.png"), *scene);
  const auto plots = draw_plots(plots_of(record));
  write_image(directory.path("plots.png"), plots);
  Report report = report_of(record, scene, plots);
  report.arguments = arguments;
  report.options = options_yaml;
  write_report(directory.path("report.html"), report);
}

}  // namespace alidade
