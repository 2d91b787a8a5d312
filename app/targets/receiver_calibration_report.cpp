// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_report.h"

#include <cmath>

#include <fmt/format.h>

#include "app/scene_picture.h"
#include "app/targets/receiver_calibration_picture.h"
#include "app/targets/receiver_calibration_summary.h"
#include "io/image_files.h"
#include "io/receiver_file.h"
#include "io/trajectory_writer.h"
#include "view/report.h"

namespace alidade {
namespace {

void write_path(const std::filesystem::path& path, const std::vector<TimedPosition>& positions) {
  TumWriter writer(path, "target");
  for (const TimedPosition& position : positions) {
    StampedPose pose;
    pose.time = position.time;
    pose.T_world_camera.translation() = position.p;
    writer.write(pose);
  }
  writer.commit();
}

std::string cell(const std::optional<double>& value, const char* pattern = "{:.2f}") {
  return value ? fmt::format(fmt::runtime(pattern), *value) : std::string();
}

ReportTable residual_table(const ReceiverCalibrationRun& run) {
  ReportTable table{
      "Residuals about the path",
      {"receiver", "id", "readings", "median as given (px)", "median (px)", "unexplained, slow (px)", "remark"},
      {}};
  for (const CalibratedReceiver& one : run.receivers) {
    table.rows.push_back({name_of(one.given), fmt::format("{}", one.given.id), fmt::format("{}", one.after.readings),
                          cell(one.before.median_px), cell(one.after.median_px), cell(one.wander_px), one.left_why});
  }
  return table;
}

// A change, and its standard deviation where it is told; of what was not looked for that is zero.
std::string with_sigma(double change, const std::optional<double>& sigma, int digits) {
  if (sigma && *sigma == 0.0) return "stands";
  return sigma ? fmt::format("{:.{}f} ± {:.{}f}", change, digits, *sigma, digits)
               : fmt::format("{:.{}f}", change, digits);
}

ReportTable change_table(const ReceiverCalibrationRun& run) {
  ReportTable table{"Changes, with standard deviations where they are known",
                    {"receiver", "place (m)", "turn (mrad)", "clock (ms)", "clock rate (ppm)", "rolling shutter (ms)",
                     "focal lengths (%)"},
                    {}};
  for (const CalibratedReceiver& one : run.receivers) {
    if (!one.is_calibrated()) continue;
    const auto length = [&](int first, double unit, int digits) {
      std::optional<double> sigma;
      if (one.sigma) sigma = unit * one.sigma->segment<3>(first).norm();
      return with_sigma(unit * one.change.segment<3>(first).norm(), sigma, digits);
    };
    const auto number = [&](int place, double unit, int digits) {
      std::optional<double> sigma;
      if (one.sigma) sigma = unit * (*one.sigma)[place];
      return with_sigma(unit * one.change[place], sigma, digits);
    };
    table.rows.push_back({name_of(one.given), length(kTranslation, 1.0, 3), length(kRotation, 1e3, 2),
                          number(kClockOffset, 1e3, 1), number(kClockRate, 1e6, 1), number(kReadout, 1e3, 1),
                          number(kFocal, 1e2, 2)});
  }
  return table;
}

ReportSection section_of(const CalibratedReceiver& one) {
  ReportSection section{name_of(one.given), {}, {}, {}};
  section.figures.push_back({draw_residuals(one), "", FigureFormat::Png});
  section.figures.push_back({draw_plot(residuals_over_time(one), {960, 320}), "", FigureFormat::Png});
  return section;
}

Report report_of(const ReceiverCalibrationRun& run, const std::optional<cv::Mat>& scene) {
  Report report;
  report.title = "Calibration of receivers";
  report.summary = rows_of(table_lines(run));
  report.warnings = run.warnings;
  const std::string how =
      run.has_truth()
          ? "Each camera is resected by itself from its readings of a target whose path is known. Standard "
            "deviations count blocks of time, since neighbouring readings err alike."
          : "Path and cameras were found together. What no reading tells, where, how large and when all of it "
            "is, stays as given; standard deviations are not told, and covariances stay as given.";
  ReportSection receivers{"Receivers", {how}, {}, {}};
  if (scene) receivers.figures.push_back({*scene, "", FigureFormat::Png});
  receivers.tables = {residual_table(run), change_table(run)};
  report.sections.push_back(std::move(receivers));
  for (const CalibratedReceiver& one : run.receivers) {
    if (one.given.camera && !one.after.samples.empty()) report.sections.push_back(section_of(one));
  }
  report.links = {{"receivers.yaml", "the calibrated receivers, for track targets"}};
  if (!run.has_truth()) report.links.push_back({"trajectory.tum", "the target's path (TUM)"});
  return report;
}

}  // namespace

void write_calibration(ReceiverCalibrationRun& run, const ResultDirectory& directory,
                       const std::vector<std::string>& arguments, const std::string& options_yaml) {
  std::vector<Receiver> found;
  for (const CalibratedReceiver& one : run.receivers) found.push_back(one.found);
  write_receivers(directory.path("receivers.yaml"), found);
  if (!run.has_truth()) write_path(directory.path("trajectory.tum"), run.path);
  const auto scene = draw_scene(scene_of(run), {0.9, 0.5, 1.0}, "the receivers", run.warnings);
  if (scene) write_image(directory.path("scene.png"), *scene);
  Report report = report_of(run, scene);
  report.arguments = arguments;
  report.options = options_yaml;
  directory.write_text("options.yaml", options_yaml);
  write_report(directory.path("report.html"), report);
}

}  // namespace alidade
