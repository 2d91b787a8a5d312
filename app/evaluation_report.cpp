// SPDX-License-Identifier: Apache-2.0
#include "app/evaluation_report.h"

#include <array>
#include <limits>

#include <fmt/format.h>

#include "view/plot.h"

namespace alidade {
namespace {

constexpr std::array<const char*, 3> kAxisLabels{"x (m)", "y (m)", "z (m)"};
const cv::Size kPathSize{960, 640};

struct Axes {
  int across = 0, up = 1;
};

// The two axes along which the path extends most, in alphabetical order.
Axes widest_axes(const Trajectory& path) {
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const StampedPose& pose : path) {
    low = low.min(pose.T_world_camera.translation().array());
    high = high.max(pose.T_world_camera.translation().array());
  }
  int least = 0;
  (high - low).minCoeff(&least);
  return {least == 0 ? 1 : 0, least == 2 ? 1 : 2};
}

Series path_series(std::string name, const Trajectory& path, Axes axes, Rgb colour) {
  Series series{std::move(name), {}, {}, SeriesStyle::Line, colour};
  for (const StampedPose& pose : path) {
    series.x.push_back(pose.T_world_camera.translation()(axes.across));
    series.y.push_back(pose.T_world_camera.translation()(axes.up));
  }
  return series;
}

std::vector<double> seconds_since_start(const Trajectory& path) {
  std::vector<double> seconds;
  for (const StampedPose& pose : path) seconds.push_back(to_seconds(pose.time - path.front().time));
  return seconds;
}

Plot plot_over(const std::string& time_label, const std::string& label, const std::vector<double>& seconds,
               const std::vector<double>& values) {
  return {"", time_label, label, {{"", seconds, values, SeriesStyle::Line, palette::kEstimate}}, false, false};
}

std::vector<double> nees_or_gap(const Consistency& consistency) {
  std::vector<double> values;
  for (const auto& nees : consistency.nees) values.push_back(nees.value_or(std::numeric_limits<double>::quiet_NaN()));
  return values;
}

ReportRow row(std::string name, double value, std::string unit, std::string remark = "") {
  return {std::move(name), fmt::format("{:.6g}", value), std::move(unit), Verdict::None, std::move(remark)};
}

}  // namespace

cv::Mat draw_paths(const EvaluationRecord& record) {
  const PairedTrajectories& pairs = record.evaluation.pairs;
  const Axes axes = widest_axes(pairs.truth);
  Plot plot;
  plot.title = "Path of the camera";
  plot.x_label = kAxisLabels[static_cast<std::size_t>(axes.across)];
  plot.y_label = kAxisLabels[static_cast<std::size_t>(axes.up)];
  plot.equal_axes = true;
  plot.series = {path_series("truth", pairs.truth, axes, palette::kTruth),
                 path_series("estimate", pairs.estimate, axes, palette::kEstimate)};
  plot.series[1].style = SeriesStyle::Dashed;
  return draw_plot(plot, kPathSize);
}

cv::Mat draw_errors(const EvaluationRecord& record) {
  const Evaluation& e = record.evaluation;
  const std::vector<double> seconds = seconds_since_start(e.pairs.truth);
  const std::string time = record.truth.has_times ? "time (s)" : "number of the pose";
  std::vector<Plot> plots{plot_over(time, "position error (m)", seconds, e.absolute.translation_m.values),
                          plot_over(time, "rotation error (deg)", seconds, e.absolute.rotation_deg.values)};
  if (e.consistency) {
    plots.push_back(plot_over(time, "NEES (6 degrees of freedom)", seconds, nees_or_gap(*e.consistency)));
    plots.back().log_y = true;
  }
  return draw_plots(plots);
}

Report report_of(const EvaluationRecord& record, const std::vector<std::string>& arguments,
                 const std::string& options) {
  const Evaluation& e = record.evaluation;
  const std::string alignment = name_of(record.options.alignment);
  const std::string step = name_of(record.options.step);
  Report report;
  report.title = "A trajectory against its truth";
  report.arguments = arguments;
  report.options = options;
  report.summary = {
      row("poses associated", static_cast<double>(e.pairs.truth.size()), "",
          fmt::format("of {} estimated and {} true ones", record.estimate.poses.size(), record.truth.poses.size())),
      row("length of the path", e.path.path_length_m, "m"),
      row("scale of the alignment", e.alignment.scale, "", alignment),
      row("absolute position error, RMSE", e.absolute.translation_m.statistics.rmse, "m"),
      row("mean position error in percent of the path", e.path.translation_percent.statistics.mean, "%"),
      row("absolute rotation error, RMSE", e.absolute.rotation_deg.statistics.rmse, "deg")};
  if (!e.relative.spans.empty()) {
    report.summary.push_back(
        row("relative position error over " + step + ", RMSE", e.relative.translation_m.statistics.rmse, "m"));
    report.summary.push_back(
        row("relative rotation error over " + step + ", RMSE", e.relative.rotation_deg.statistics.rmse, "deg"));
  }
  if (const auto& c = e.consistency) {
    report.summary.push_back(row("mean NEES per degree of freedom", c->mean_per_degree, "",
                                 fmt::format("1 is honest; 95 % bounds {:.3f} to {:.3f}", c->lower, c->upper)));
  }
  report.sections = {{"Path", {}, {}, {{draw_paths(record), "Truth and aligned estimate.", FigureFormat::Png}}},
                     {"Errors", {}, {}, {{draw_errors(record), "After the alignment.", FigureFormat::Png}}}};
  report.links = {{"errors.csv", "the errors of every pose"}, {"summary.json", "all statistics"}};
  return report;
}

}  // namespace alidade
