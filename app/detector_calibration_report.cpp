// SPDX-License-Identifier: Apache-2.0
#include "app/detector_calibration_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/detector_scene.h"
#include "app/scene_picture.h"
#include "io/body_file.h"
#include "io/detector_file.h"
#include "io/image_files.h"
#include "io/table.h"
#include "io/trajectory_writer.h"
#include "view/report.h"

namespace alidade {
namespace {

using StatisticsById = std::map<int, ReadingStatistics>;

void write_stations(const std::filesystem::path& path, const std::vector<StationMove>& moves) {
  constexpr std::array<std::string_view, 13> kColumns{
      "station",   "dx_m",      "dy_m",      "dz_m",         "drx_rad",      "dry_rad",     "drz_rad",
      "sigma_x_m", "sigma_y_m", "sigma_z_m", "sigma_rx_rad", "sigma_ry_rad", "sigma_rz_rad"};
  TableWriter table(path, kColumns);
  for (const StationMove& move : moves) {
    std::vector<TableCell> cells{move.station};
    for (const double value : move.change) cells.emplace_back(value);
    for (int i = 0; i < 6; ++i) cells.push_back(move.sigma ? TableCell((*move.sigma)[i]) : TableCell(std::string()));
    table.write_row(cells);
  }
  table.commit();
}

// What is told of residuals, on which readings and with which detectors.
struct NamedStatistics {
  std::string recording, detectors;
  const DetectorCalibration* statistics;
};

std::vector<NamedStatistics> all_statistics(const DetectorCalibrationRun& run) {
  std::vector<NamedStatistics> all{{"calibration", "refined", &run.refined}};
  if (run.verification) {
    all.push_back({"verification", "given", &run.verification->before});
    all.push_back({"verification", "refined", &run.verification->after});
  }
  return all;
}

void write_residuals(const std::filesystem::path& path, const DetectorCalibrationRun& run) {
  constexpr std::array<std::string_view, 8> kColumns{"recording", "detectors",     "of",        "id", "readings",
                                                     "explained", "median_sigmas", "rms_sigmas"};
  TableWriter table(path, kColumns);
  for (const NamedStatistics& named : all_statistics(run)) {
    for (const char* of : {"detector", "marker"}) {
      const bool is_detector = std::string_view(of) == "detector";
      for (const auto& [id, s] : is_detector ? named.statistics->by_detector : named.statistics->by_marker) {
        table.write_row({named.recording, named.detectors, std::string(of), std::int64_t{id}, std::int64_t{s.count},
                         std::int64_t{s.inlier_count}, s.median_sigmas, s.rms_sigmas});
      }
    }
  }
  table.commit();
}

Plot residual_plot(const std::string& of, const StatisticsById DetectorCalibration::*statistics,
                   const DetectorCalibrationRun& run) {
  Plot plot{"Median of the absolute residuals by " + of, of, "sigma", {}, false, true, true};
  for (const NamedStatistics& named : all_statistics(run)) {
    Series series{named.recording + ", " + named.detectors + " detectors", {}, {}, SeriesStyle::Dots, {}};
    for (const auto& [id, s] : named.statistics->*statistics) {
      series.x.push_back(id);
      series.y.push_back(s.median_sigmas);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot move_plot(const DetectorCalibrationRun& run, int first, const std::string& title, const std::string& unit) {
  Plot plot{title, "station, in the file's order (the first is 1)", unit, {}, false, true, true};
  plot.series = {{"moved by", {}, {}, SeriesStyle::Dots, {}}, {"standard deviation", {}, {}, SeriesStyle::Dots, {}}};
  double place = 0.0;
  for (const StationMove& move : station_moves(run)) {
    place += 1.0;
    if (!move.sigma) continue;
    plot.series[0].x.push_back(place);
    plot.series[0].y.push_back(1e3 * move.change.segment<3>(first).norm());
    plot.series[1].x.push_back(place);
    plot.series[1].y.push_back(1e3 * move.sigma->segment<3>(first).norm());
  }
  return plot;
}

ReportTable station_table(const DetectorCalibrationRun& run) {
  ReportTable table{"How far the stations moved, with standard deviations",
                    {"station", "moved (mm)", "sigma (mm)", "turned (mrad)", "sigma (mrad)"},
                    {}};
  for (const StationMove& m : station_moves(run)) {
    const auto sigma = [&](int first) {
      return m.sigma ? fmt::format("{:.3g}", 1e3 * m.sigma->segment<3>(first).norm()) : std::string("held");
    };
    table.rows.push_back({m.station, fmt::format("{:.2f}", 1e3 * m.change.head<3>().norm()), sigma(0),
                          fmt::format("{:.3f}", 1e3 * m.change.tail<3>().norm()), sigma(3)});
  }
  return table;
}

ReportTable residual_table(const std::string& title, const std::string& of, const StatisticsById& statistics) {
  ReportTable table{title, {of, "readings", "explained", "median (sigma)", "RMS of the explained (sigma)"}, {}};
  for (const auto& [id, s] : statistics) {
    table.rows.push_back({std::to_string(id), std::to_string(s.count),
                          fmt::format("{:.2f} %", 100.0 * s.inlier_share()), fmt::format("{:.3f}", s.median_sigmas),
                          fmt::format("{:.3f}", s.rms_sigmas)});
  }
  return table;
}

Report report_of(const DetectorCalibrationRun& run, const std::optional<cv::Mat>& scene, const cv::Mat& plots) {
  Report report;
  report.title = "Calibration of detectors from " + run.source;
  report.summary = rows_of(table_lines(run));
  report.warnings = run.warnings;
  if (scene) {
    report.sections.push_back({"Stations and path",
                               {"Stations where they were given and where they are now; the path is the body's during "
                                "the calibration."},
                               {},
                               {{*scene, "", FigureFormat::Png}}});
  }
  report.sections.push_back({"Stations",
                             {"Standard deviations are given the held station, along each station's own "
                              "axes."},
                             {},
                             {},
                             {station_table(run)}});
  report.sections.push_back({"Residuals and moves", {}, {}, {{plots, "", FigureFormat::Png}}});
  ReportSection tables{"Residuals", {"In units of the readings' standard deviation."}, {}, {}, {}};
  for (const NamedStatistics& named : all_statistics(run)) {
    const std::string title = fmt::format("{}, {} detectors", named.recording, named.detectors);
    tables.tables.push_back(residual_table(title, "detector", named.statistics->by_detector));
    tables.tables.push_back(residual_table(title, "marker", named.statistics->by_marker));
  }
  report.sections.push_back(std::move(tables));
  report.links = {{"detectors.yaml", "the refined detectors, with covariances of their stations, for track body"},
                  {"body.csv", "the body that belongs to them"},
                  {"trajectory.tum", "the body's motion (TUM), body to world"},
                  {"stations.csv", "how far each station moved, with standard deviations"},
                  {"residuals.csv", "residuals by detector and marker"}};
  return report;
}

}  // namespace

std::vector<Plot> plots_of(const DetectorCalibrationRun& run) {
  return {residual_plot("detector", &DetectorCalibration::by_detector, run),
          residual_plot("marker", &DetectorCalibration::by_marker, run),
          move_plot(run, 0, "How far stations moved", "mm"), move_plot(run, 3, "How far stations turned", "mrad")};
}

Scene scene_of(const DetectorCalibrationRun& run) {
  Scene scene;
  scene.up_world = Eigen::Vector3d::UnitZ();
  Eigen::AlignedBox3d box;
  for (const LineDetector& detector : run.refined.rig.detectors) box.extend(centre_world(detector));
  for (const StampedPose& pose : run.refined.motion) box.extend(pose.T_world_camera.translation());
  const double size_m = std::max(1e-3, 0.04 * box.diagonal().norm());
  std::vector<LineDetector> moved = run.given.rig.detectors;
  std::erase_if(moved, [&](const auto& d) { return !run.refined.rig.station_covariance.contains(d.station); });
  add_detectors(moved, {size_m, palette::kReference, false}, scene);
  add_detectors(run.refined.rig.detectors, {size_m, palette::kInk, true}, scene);
  scene.paths.push_back(scene_path(run.refined.motion, palette::kEstimate, std::chrono::milliseconds(300)));
  scene.legend = {{"moved stations as given", palette::kReference, PyramidStyle::Hollow},
                  {"detectors, refined", palette::kInk, PyramidStyle::Hollow},
                  {"the body's path", palette::kEstimate, PyramidStyle::Solid}};
  add_station_covariances(run.refined.rig, 0.7 * size_m, scene);
  return scene;
}

void write_calibration(DetectorCalibrationRun& run, const ResultDirectory& directory,
                       const std::vector<std::string>& arguments, const std::string& options_yaml) {
  write_detector_rig(directory.path("detectors.yaml"), run.refined.rig);
  write_bodies(directory.path("body.csv"), std::span(&run.refined.body, 1));
  TumWriter trajectory(directory.path("trajectory.tum"), "body");
  for (const StampedPose& pose : run.refined.motion) trajectory.write(pose);
  trajectory.commit();
  write_stations(directory.path("stations.csv"), station_moves(run));
  write_residuals(directory.path("residuals.csv"), run);
  const auto scene = draw_scene(scene_of(run), {0.7, 0.45, 1.0}, "the stations", run.warnings);
  if (scene) write_image(directory.path("scene.png"), *scene);
  const cv::Mat plots = draw_plots(plots_of(run));
  write_image(directory.path("plots.png"), plots);
  Report report = report_of(run, scene, plots);
  report.arguments = arguments;
  report.options = options_yaml;
  directory.write_text("options.yaml", options_yaml);
  write_report(directory.path("report.html"), report);
}

}  // namespace alidade
