// SPDX-License-Identifier: Apache-2.0
#include "app/body_report.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/body_picture.h"
#include "app/scene_picture.h"
#include "geometry/rotation.h"
#include "io/image_files.h"
#include "view/report.h"

namespace alidade {
namespace {

constexpr ViewAngles kAngles{0.7, 0.45, 1.0};
constexpr double kDegrees = 180.0 / std::numbers::pi;

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : 0.0;
}

double ratio(std::int64_t part, std::int64_t whole) {
  return ratio(static_cast<double>(part), static_cast<double>(whole));
}

double duration_s(const BodyRun& run) {
  return to_seconds(run.last - run.first);
}

double batch_rate_hz(const BodyRun& run) {
  return ratio(static_cast<double>(run.batches - 1), duration_s(run));
}

// Of all vectors of this rotation the one nearest to the one before, so that a curve does not jump where it passes π.
Eigen::Vector3d unwound(const Eigen::Vector3d& rotation, const Eigen::Vector3d& before) {
  const double angle = rotation.norm();
  if (angle < 1e-9) return rotation;
  const Eigen::Vector3d axis = rotation / angle;
  const double turns = std::round((axis.dot(before) - angle) / (2.0 * std::numbers::pi));
  return rotation + 2.0 * std::numbers::pi * turns * axis;
}

// Curves over one axis of time.
struct Curves {
  Plot plot;

  Curves(std::string title, std::string unit, std::initializer_list<const char*> names, bool log_y = false) {
    plot = {std::move(title), "time (s)", std::move(unit), {}, false, log_y};
    for (const char* name : names) plot.series.push_back({name, {}, {}, SeriesStyle::Line, {}});
  }

  void add(double time_s, std::initializer_list<double> values) {
    auto series = plot.series.begin();
    for (const double value : values) {
      series->x.push_back(time_s);
      series->y.push_back(value);
      ++series;
    }
  }
};

nlohmann::json summary_of(const BodyRun& run, std::size_t body) {
  const BodyTally& tally = run.tallies[body];
  nlohmann::json summary{
      {"name", run.bodies[body].name}, {"markers", run.bodies[body].markers.size()},
      {"batches", tally.batches()},    {"tracked", tally.tracked},
      {"ambiguous", tally.ambiguous},  {"lost", tally.lost},
      {"readings", tally.readings},    {"readings_explained", ratio(tally.explained, tally.readings)}};
  if (run.detail == PoseDetail::Motion && tally.tracked > 0) {
    const auto tracked = static_cast<double>(tally.tracked);
    summary["mean_sigma_position_m"] = tally.position_sigma_sum_m / tracked;
    summary["mean_sigma_rotation_rad"] = tally.rotation_sigma_sum_rad / tracked;
  }
  return summary;
}

ReportTable residual_table(const BodyRun& run, const std::string& of, const std::string& whose) {
  ReportTable table{"Residuals by " + of,
                    {of, whose, "unit", "readings", "explained", "RMS (sigma)", "mean (sigma)", "RMS", "median"},
                    {}};
  for (const ResidualRow& row : run.residuals) {
    if (row.of != of) continue;
    table.rows.push_back({std::to_string(row.id), row.name, row.unit, std::to_string(row.readings),
                          fmt::format("{:.2f} %", 100.0 * ratio(row.inliers, row.readings)),
                          fmt::format("{:.3f}", row.rms_sigma), fmt::format("{:+.3f}", row.mean_sigma),
                          fmt::format("{:.3g}", row.rms), fmt::format("{:.3g}", row.median_magnitude)});
  }
  return table;
}

ReportTable signal_table(const BodyRun& run) {
  ReportTable table{"Spots of light", {"detector", "rows", "spots", "identified"}, {}};
  for (const DetectorSignal& signal : run.signals) {
    table.rows.push_back({std::to_string(signal.detector), std::to_string(signal.rows), std::to_string(signal.spots),
                          fmt::format("{:.2f} %", 100.0 * ratio(signal.identified, signal.spots))});
  }
  return table;
}

nlohmann::json summary_of(const std::vector<DetectorSignal>& signals) {
  nlohmann::json summary = nlohmann::json::array();
  for (const DetectorSignal& s : signals) {
    summary.push_back({{"detector", s.detector}, {"rows", s.rows}, {"spots", s.spots}, {"identified", s.identified}});
  }
  return summary;
}

Report report_of(const BodyRun& run, const std::optional<cv::Mat>& scene, const std::vector<cv::Mat>& plots) {
  Report report;
  report.title = "Body track of " + run.source;
  report.summary = rows_of(table_lines(run));
  report.warnings = run.warnings;
  if (run.fault) report.warnings.push_back("ended early: " + *run.fault);
  if (run.interrupted) report.warnings.emplace_back("interrupted: the observations go on");
  if (scene) {
    report.sections.push_back({"Detectors, planes, markers and path",
                               {"Lines of sight, and the planes of one marker, are those of the batch with the most "
                                "readings explained."},
                               {},
                               {{*scene, "", FigureFormat::Png}}});
  }
  for (std::size_t i = 0; i < plots.size(); ++i) {
    report.sections.push_back({run.bodies[i].name + " over time", {}, {}, {{plots[i], "", FigureFormat::Png}}});
  }
  if (!run.signals.empty()) {
    report.sections.push_back({"Line images",
                               {"Spots that are not identified lie where markers cross, come before their code was "
                                "seen once, or are none of the markers."},
                               {},
                               {},
                               {signal_table(run)}});
  }
  report.sections.push_back({"Residuals",
                             {"Of each reading about the pose right after its batch; RMS, mean and median are of the "
                              "readings that are explained. In units of sigma the RMS is near 1 where the detectors' "
                              "noise is stated rightly; a mean away from 0 is an error of calibration."},
                             {},
                             {},
                             {residual_table(run, "detector", "station"), residual_table(run, "marker", "body")}});
  report.links = {{"poses.csv", "every batch: pose, velocities, standard deviations (body axes), readings"},
                  {"markers.trc", "markers of tracked poses (OpenSim; y is up)"},
                  {"residuals.csv", "residuals by detector and marker"}};
  if (!run.signals.empty()) report.links.push_back({"readings.csv", "the identified spots"});
  if (run.bodies.size() == 1) report.links.push_back({"trajectory.tum", "tracked poses (TUM), body to world"});
  return report;
}

}  // namespace

nlohmann::json summary_of(const BodyRun& run) {
  nlohmann::json summary{{"source", run.source},
                         {"method", run.method},
                         {"detectors", run.detectors.size()},
                         {"batches", run.batches},
                         {"duration_s", duration_s(run)},
                         {"batch_rate_hz", batch_rate_hz(run)},
                         {"tracking_s", run.tracking_s},
                         {"batches_per_s", ratio(static_cast<double>(run.batches), run.tracking_s)},
                         {"interrupted", run.interrupted},
                         {"warnings", run.warnings}};
  if (run.fault) summary["fault"] = *run.fault;
  if (!run.signals.empty()) summary["signals"] = summary_of(run.signals);
  summary["bodies"] = nlohmann::json::array();
  for (std::size_t i = 0; i < run.bodies.size(); ++i) {
    summary["bodies"].push_back(summary_of(run, i));
  }
  return summary;
}

std::vector<std::string> table_lines(const BodyRun& run) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < run.bodies.size(); ++i) {
    const BodyTally& t = run.tallies[i];
    lines.push_back(fmt::format("{}: {} tracked, {} ambiguous, {} lost, of {} batches", run.bodies[i].name, t.tracked,
                                t.ambiguous, t.lost, t.batches()));
    if (t.tracked == 0) continue;
    const auto tracked = static_cast<double>(t.tracked);
    lines.push_back(
        fmt::format("  readings: {:.2f} % of {} explained", 100.0 * ratio(t.explained, t.readings), t.readings));
    if (run.detail == PoseDetail::Pose) continue;
    lines.push_back(fmt::format("  mean sigma: {:.4g} mm, {:.4g} mrad", 1e3 * t.position_sigma_sum_m / tracked,
                                1e3 * t.rotation_sigma_sum_rad / tracked));
  }
  lines.push_back(fmt::format("recording: {:.3f} s, {:.1f} batches/s", duration_s(run), batch_rate_hz(run)));
  lines.push_back(fmt::format("speed: {:.0f} batches/s", ratio(static_cast<double>(run.batches), run.tracking_s)));
  return lines;
}

std::vector<Plot> plots_of(const BodyRun& run, std::size_t body) {
  constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
  Curves position("Position", "m", {"x", "y", "z"});
  Curves attitude("Rotation vector", "deg", {"x", "y", "z"});
  Curves sigma_m("Standard deviation of the position", "mm", {"x", "y", "z"}, true);
  Curves sigma_rad("Standard deviation of the attitude", "mrad", {"x", "y", "z"}, true);
  Curves share("Readings explained", "share", {"of the batch"});
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (const BodySample& s : run.tallies.at(body).samples.values()) {
    const double t = to_seconds(s.time - run.first);
    share.add(t, {s.inlier_share.value_or(kGap)});
    if (s.status != BodyStatus::Tracked) {
      for (Curves* curves : {&position, &attitude, &sigma_m, &sigma_rad}) curves->add(t, {kGap, kGap, kGap});
      continue;
    }
    const Eigen::Vector3d p = s.T_world_body.translation();
    before = unwound(log_so3(s.T_world_body.linear()), before);
    const Eigen::Vector3d turn = kDegrees * before;
    const Vector6d sigma = 1e3 * s.covariance.diagonal().cwiseSqrt();
    position.add(t, {p.x(), p.y(), p.z()});
    attitude.add(t, {turn.x(), turn.y(), turn.z()});
    sigma_m.add(t, {sigma(0), sigma(1), sigma(2)});
    sigma_rad.add(t, {sigma(3), sigma(4), sigma(5)});
  }
  if (run.detail == PoseDetail::Pose) return {position.plot, attitude.plot, share.plot};
  return {position.plot, attitude.plot, sigma_m.plot, sigma_rad.plot, share.plot};
}

void write_body_report(BodyRun& run, const ResultDirectory& directory, const std::vector<std::string>& arguments,
                       const std::string& options_yaml) {
  const auto scene = draw_scene(scene_of(run), kAngles, "the scene", run.warnings);
  if (scene) write_image(directory.path("scene.png"), *scene);
  std::vector<cv::Mat> plots;
  for (std::size_t i = 0; i < run.bodies.size(); ++i) {
    plots.push_back(draw_plots(plots_of(run, i)));
    write_image(directory.path(run.bodies.size() == 1 ? "plots.png" : fmt::format("plots_{}.png", i + 1)), plots[i]);
  }
  Report report = report_of(run, scene, plots);
  report.arguments = arguments;
  report.options = options_yaml;
  directory.write_text("options.yaml", options_yaml);
  write_report(directory.path("report.html"), report);
}

}  // namespace alidade
