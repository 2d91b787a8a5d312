// SPDX-License-Identifier: Apache-2.0
#include "app/detector_calibration_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/detector_scene.h"
#include "core/errors.h"
#include "io/body_file.h"
#include "io/detector_file.h"
#include "io/image_files.h"
#include "io/table.h"
#include "io/trajectory_writer.h"
#include "view/renderer.h"
#include "view/report.h"
#include "view/viewpoint.h"

namespace alidade {
namespace {

using StatisticsById = std::map<int, ReadingStatistics>;

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0.0;
}

std::vector<double> list_of(const Vector6d& values) {
  return {values.begin(), values.end()};
}

std::string name_of(CalibrationOutcome outcome) {
  switch (outcome) {
    case CalibrationOutcome::Refined:
      return "refined";
    case CalibrationOutcome::TooFewReadings:
      return "too few readings";
    case CalibrationOutcome::NoStart:
      return "no start";
    case CalibrationOutcome::Undetermined:
      return "undetermined";
    case CalibrationOutcome::Stopped:
      return "stopped";
  }
  return "";
}

nlohmann::json json_of(const StatisticsById& statistics) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [id, s] : statistics) {
    list.push_back({{"id", id},
                    {"readings", s.count},
                    {"explained", s.inlier_count},
                    {"median_sigmas", s.median_sigmas},
                    {"rms_sigmas", s.rms_sigmas}});
  }
  return list;
}

nlohmann::json json_of(const Statistics& s) {
  return {{"mean_m", s.mean}, {"median_m", s.median}, {"rmse_m", s.rmse}, {"max_m", s.max}, {"count", s.count}};
}

nlohmann::json json_of(const ReferenceErrors& errors) {
  nlohmann::json json{{"asked", errors.asked},
                      {"answered", errors.answered},
                      {"answered_share", share(errors.answered, errors.asked)},
                      {"before", json_of(errors.before_m)},
                      {"after", json_of(errors.after_m)}};
  if (errors.onboard_m) {
    json["onboard"] = json_of(*errors.onboard_m);
    json["ratio"] = errors.after_m.mean / errors.onboard_m->mean;
  }
  return json;
}

nlohmann::json json_of(const DetectorVerification& v) {
  nlohmann::json json{
      {"outcome", name_of(v.after.outcome)},
      {"before", {{"detectors", json_of(v.before.by_detector)}, {"markers", json_of(v.before.by_marker)}}},
      {"after", {{"detectors", json_of(v.after.by_detector)}, {"markers", json_of(v.after.by_marker)}}},
      {"windows",
       {{"count", v.windows.windows},
        {"explained", v.windows.explained},
        {"explained_share", share(v.windows.explained, v.windows.windows)},
        {"most_parameters", v.windows.largest_fit},
        {"median_sigmas", v.windows.median_sigmas}}}};
  if (v.windows.median_rad) json["windows"]["median_rad"] = *v.windows.median_rad;
  if (v.errors) json["reference"] = json_of(*v.errors);
  return json;
}

// A typical residual of all: the median over detectors of their medians would hide a bad one, the worst is told.
double worst_median(const StatisticsById& statistics) {
  double worst = 0.0;
  for (const auto& [id, s] : statistics) worst = std::max(worst, s.median_sigmas);
  return worst;
}

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
  Plot plot{"Median of the absolute residuals by " + of, of, "sigma", {}, false, true};
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
  Plot plot{title, "station, in the file's order (the first is 1)", unit, {}, false, true};
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
                          fmt::format("{:.2f} %", 100.0 * share(s.inlier_count, s.count)),
                          fmt::format("{:.3f}", s.median_sigmas), fmt::format("{:.3f}", s.rms_sigmas)});
  }
  return table;
}

std::optional<cv::Mat> draw_scene(DetectorCalibrationRun& run) {
  const cv::Size size(1500, 1000);
  try {
    const Scene scene = scene_of(run);
    return render(scene, frame_scene(scene, {0.7, 0.45, 1.0}, static_cast<double>(size.width) / size.height), size);
  } catch (const DeviceError& error) {
    run.warnings.push_back(fmt::format("no picture of the stations: {}", error.what()));
    return std::nullopt;
  }
}

Report report_of(const DetectorCalibrationRun& run, const std::optional<cv::Mat>& scene, const cv::Mat& plots) {
  Report report;
  report.title = "Calibration of detectors from " + run.source;
  for (const std::string& line : table_lines(run)) {
    const auto colon = line.find(": ");
    report.summary.push_back({line.substr(0, colon), line.substr(colon + 2), "", Verdict::None, ""});
  }
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

std::vector<std::string> verification_lines(const DetectorVerification& v) {
  if (v.after.outcome != CalibrationOutcome::Refined) {
    return {fmt::format("verification: {}, the refined detectors were not tried", name_of(v.after.outcome))};
  }
  std::vector<std::string> lines;
  lines.push_back(fmt::format("verification: worst median residual {:.2f} sigma (detectors as given: {:.2f})",
                              worst_median(v.after.by_detector), worst_median(v.before.by_detector)));
  const WindowStatistics& w = v.windows;
  lines.push_back(fmt::format("windows: {:.2f} % of {} explained, each by itself, median residual {:.3f} sigma{}",
                              100.0 * share(w.explained, w.windows), w.windows, w.median_sigmas,
                              w.median_rad ? fmt::format(" ({:.4f} mrad)", 1e3 * *w.median_rad) : ""));
  if (!v.errors) return lines;
  lines.push_back(fmt::format("mean error: {:.2f} mm, with the detectors as given {:.2f} mm ({} of {} instants)",
                              1e3 * v.errors->after_m.mean, 1e3 * v.errors->before_m.mean, v.errors->answered,
                              v.errors->asked));
  if (v.errors->onboard_m) {
    lines.push_back(fmt::format("the other estimate: {:.2f} mm at the same instants; ratio {:.3f}",
                                1e3 * v.errors->onboard_m->mean, v.errors->after_m.mean / v.errors->onboard_m->mean));
  }
  return lines;
}

}  // namespace

std::string explain(CalibrationOutcome outcome) {
  switch (outcome) {
    case CalibrationOutcome::TooFewReadings:
      return "too few readings: 24 of each station are the least; record longer, or leave out stations that see "
             "nothing";
    case CalibrationOutcome::NoStart:
      return "no pose of the body explains the first readings; are the body, the detectors and the unit of the "
             "readings those of this recording? else place the stations better, to some degrees";
    case CalibrationOutcome::Undetermined:
      return "the readings do not determine where the stations stand; move and turn the body through the whole space, "
             "in view of several stations at once";
    case CalibrationOutcome::Stopped:
      return "stopped before the stations were moved";
    case CalibrationOutcome::Refined:
      break;
  }
  return "refined";
}

void add_warnings(DetectorCalibrationRun& run) {
  if (run.interrupted) run.warnings.emplace_back("interrupted: the detectors are those of the last iteration");
  if (!run.refined.is_converged && !run.interrupted) {
    run.warnings.push_back(fmt::format("the calibration has not settled after {} iterations; raise --max-iterations",
                                       run.refined.iterations));
  }
  if (!run.verification || run.verification->after.outcome == CalibrationOutcome::Refined) return;
  run.warnings.push_back(fmt::format("not verified: {}", explain(run.verification->after.outcome)));
}

std::vector<StationMove> station_moves(const DetectorCalibrationRun& run) {
  std::vector<StationMove> moves;
  for (std::size_t i = 0; i < run.refined.rig.detectors.size(); ++i) {
    const LineDetector& now = run.refined.rig.detectors[i];
    const bool is_told =
        std::any_of(moves.begin(), moves.end(), [&](const auto& m) { return m.station == now.station; });
    if (is_told) continue;
    StationMove move{now.station, difference(run.given.rig.detectors[i].T_world_station, now.T_world_station), {}};
    const auto covariance = run.refined.rig.station_covariance.find(now.station);
    if (covariance != run.refined.rig.station_covariance.end()) {
      move.sigma = covariance->second.diagonal().cwiseSqrt();
    }
    moves.push_back(std::move(move));
  }
  return moves;
}

nlohmann::json summary_of(const DetectorCalibrationRun& run) {
  nlohmann::json stations = nlohmann::json::array();
  for (const StationMove& move : station_moves(run)) {
    nlohmann::json station{{"name", move.station}, {"held", !move.sigma}, {"change_m_rad", list_of(move.change)}};
    if (move.sigma) station["sigma_m_rad"] = list_of(*move.sigma);
    stations.push_back(std::move(station));
  }
  nlohmann::json summary{{"source", run.source},
                         {"outcome", name_of(run.refined.outcome)},
                         {"converged", run.refined.is_converged},
                         {"iterations", run.refined.iterations},
                         {"truth_aided", run.has_reference},
                         {"calibration_s", run.calibration_s},
                         {"interrupted", run.interrupted},
                         {"stations", stations},
                         {"detectors", json_of(run.refined.by_detector)},
                         {"markers", json_of(run.refined.by_marker)},
                         {"warnings", run.warnings}};
  if (run.verification) summary["verification"] = json_of(*run.verification);
  return summary;
}

std::vector<std::string> table_lines(const DetectorCalibrationRun& run) {
  std::vector<std::string> lines{fmt::format("calibration: {} after {} iterations, {:.1f} s",
                                             run.refined.is_converged ? "settled" : "not settled",
                                             run.refined.iterations, run.calibration_s)};
  for (const StationMove& move : station_moves(run)) {
    if (!move.sigma) {
      lines.push_back(fmt::format("station {}: held", move.station));
      continue;
    }
    lines.push_back(fmt::format("station {}: moved {:.2f} ± {:.2g} mm, turned {:.3f} ± {:.2g} mrad", move.station,
                                1e3 * move.change.head<3>().norm(), 1e3 * move.sigma->head<3>().norm(),
                                1e3 * move.change.tail<3>().norm(), 1e3 * move.sigma->tail<3>().norm()));
  }
  lines.push_back(fmt::format("worst median residual: {:.2f} sigma", worst_median(run.refined.by_detector)));
  if (run.verification) {
    for (std::string& line : verification_lines(*run.verification)) lines.push_back(std::move(line));
  } else {
    lines.emplace_back("verification: none; give --verify another recording, or --verify-start and --verify-end");
  }
  return lines;
}

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
  const auto scene = draw_scene(run);
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
