// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_report.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/scene_picture.h"
#include "app/targets/target_picture.h"
#include "io/image_files.h"
#include "view/report.h"

namespace alidade {
namespace {

constexpr ViewAngles kAngles{0.9, 0.5, 1.0};

template <class Count>
std::string counted(Count count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

double mean(double sum, std::int64_t count) {
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

double mean_sigma_m(const TargetTally& tally) {
  return mean(tally.position_sigma_sum_m, tally.rows);
}

nlohmann::json summary_of(int target, const TargetTally& tally) {
  nlohmann::json summary{{"target", target},
                         {"rows", tally.rows},
                         {"first_s", to_seconds(tally.first.time_since_epoch())},
                         {"last_s", to_seconds(tally.last.time_since_epoch())},
                         {"sightings", tally.sightings},
                         {"mean_position_sigma_m", mean_sigma_m(tally)},
                         {"mean_speed_m_s", mean(tally.speed_sum_m_s, tally.rows)}};
  if (tally.temperature_k) summary["temperature_k"] = *tally.temperature_k;
  if (tally.temperature_sigma_k) summary["temperature_sigma_k"] = *tally.temperature_sigma_k;
  return summary;
}

ReportTable table_of(const TargetRun& run) {
  ReportTable table{
      "Targets",
      {"target", "from (s)", "to (s)", "rows", "sightings", "sigma (m)", "speed (m/s)", "temperature (K)"},
      {}};
  for (const auto& [id, tally] : run.targets) {
    const std::string temperature = tally.temperature_k ? fmt::format("{:.1f} +- {:.1f}", *tally.temperature_k,
                                                                      tally.temperature_sigma_k.value_or(0))
                                                        : "";
    table.rows.push_back({fmt::format("{}", id), fmt::format("{:.2f}", to_seconds(tally.first - run.first)),
                          fmt::format("{:.2f}", to_seconds(tally.last - run.first)), fmt::format("{}", tally.rows),
                          fmt::format("{}", tally.sightings), fmt::format("{:.3g}", mean_sigma_m(tally)),
                          fmt::format("{:.3g}", mean(tally.speed_sum_m_s, tally.rows)), temperature});
  }
  return table;
}

ReportTable table_of_receivers(const TargetRun& run) {
  ReportTable table{"Receivers", {"receiver", "id", "kind", "bearings"}, {}};
  for (const Receiver& receiver : run.receivers) {
    const auto count = run.bearings_of_receiver.find(receiver.id);
    table.rows.push_back({receiver.name, fmt::format("{}", receiver.id),
                          receiver.camera ? "camera" : "direction finder",
                          fmt::format("{}", count == run.bearings_of_receiver.end() ? 0 : count->second)});
  }
  return table;
}

Report report_of(const TargetRun& run, const std::optional<cv::Mat>& scene, const cv::Mat& plots) {
  Report report;
  report.title = "Targets";
  report.warnings = run.warnings;
  if (run.interrupted) report.warnings.emplace_back("interrupted: the observations were not read to their end");
  if (run.fault) report.warnings.push_back("the observations could not be read to their end: " + *run.fault);
  report.summary = {
      {"targets", fmt::format("{}", run.targets.size()), "", run.targets.empty() ? Verdict::Poor : Verdict::Good, ""},
      {"bearings", fmt::format("{}", run.bearings), "", Verdict::None, fmt::format("from {}", run.source)},
      {"duration", fmt::format("{:.1f}", to_seconds(run.last - run.first)), "s", Verdict::None, ""},
      {"method", run.method, "", Verdict::None, ""},
      {"time", fmt::format("{:.2f}", run.tracking_s), "s", Verdict::None, "to read, track and write"}};
  ReportSection targets{"Targets", {}, {}, {}};
  if (scene) targets.figures.push_back({*scene, "", FigureFormat::Png});
  targets.tables.push_back(table_of(run));
  if (!plots.empty()) targets.figures.push_back({plots, "", FigureFormat::Png});
  report.sections.push_back(std::move(targets));
  report.sections.push_back({"Receivers", {}, {}, {}, {table_of_receivers(run)}});
  report.links = {{"tracks.csv", "every estimate with identity and covariance"},
                  {"tracks", "positions of each target (TUM)"},
                  {"receivers.yaml", "the receivers"}};
  return report;
}

}  // namespace

nlohmann::json summary_of(const TargetRun& run) {
  nlohmann::json targets = nlohmann::json::array();
  for (const auto& [id, tally] : run.targets) targets.push_back(summary_of(id, tally));
  nlohmann::json summary{{"source", run.source},
                         {"method", run.method},
                         {"receivers", run.receivers.size()},
                         {"bearings", run.bearings},
                         {"without_direction", run.without_direction},
                         {"duration_s", to_seconds(run.last - run.first)},
                         {"tracking_s", run.tracking_s},
                         {"targets", targets},
                         {"interrupted", run.interrupted}};
  if (run.fault) summary["fault"] = *run.fault;
  return summary;
}

std::vector<std::string> table_lines(const TargetRun& run) {
  std::vector<std::string> lines{fmt::format("{} of {} in {:.1f} s: {}", counted(run.bearings, "bearing"),
                                             counted(run.bearings_of_receiver.size(), "receiver"),
                                             to_seconds(run.last - run.first), counted(run.targets.size(), "target"))};
  constexpr std::size_t kMost = 20;
  for (const auto& [id, tally] : run.targets) {
    if (lines.size() > kMost) {
      lines.push_back(fmt::format("... and {} more", run.targets.size() - kMost));
      break;
    }
    lines.push_back(fmt::format("target {}: {:.2f} to {:.2f} s, {} sightings, sigma {:.3g} m", id,
                                to_seconds(tally.first - run.first), to_seconds(tally.last - run.first),
                                tally.sightings, mean_sigma_m(tally)));
  }
  return lines;
}

void write_target_report(TargetRun& run, std::span<const TargetRow> truth, const ResultDirectory& directory,
                         const std::vector<std::string>& arguments, const std::string& options_yaml) {
  const auto scene = draw_scene(scene_of(run, truth), kAngles, "the targets", run.warnings);
  if (scene) write_image(directory.path("scene.png"), *scene);
  const cv::Mat plots = draw_plots(plots_of(run, truth));
  write_image(directory.path("plots.png"), plots);
  Report report = report_of(run, scene, plots);
  report.arguments = arguments;
  report.options = options_yaml;
  directory.write_text("options.yaml", options_yaml);
  write_report(directory.path("report.html"), report);
}

}  // namespace alidade
