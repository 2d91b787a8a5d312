// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/experiment_report.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "io/image_files.h"
#include "view/renderer.h"
#include "view/report.h"

namespace alidade {
namespace {

// Empty on a machine that cannot draw.
std::optional<cv::Mat> drawn(const ExperimentScene& scene, Report& report) {
  const cv::Size size(1500, 1000);
  try {
    const Scene all = track_scene(scene.picture);
    return render(all, frame_scene(all, {}, static_cast<double>(size.width) / size.height), size);
  } catch (const DeviceError& error) {
    report.warnings.push_back(fmt::format("{} is missing: {}", scene.file, error.what()));
    return std::nullopt;
  }
}

}  // namespace

nlohmann::json summary_of(const ExperimentRecord& record) {
  nlohmann::json summary;
  summary["object"] = record.object;
  summary["runs"] = record.runs;
  summary["interrupted"] = record.interrupted;
  for (const ExperimentSection& section : record.sections) summary[section.name] = section.summary;
  return summary;
}

void write_experiment(const ExperimentRecord& record, const std::vector<std::string>& arguments,
                      const std::string& options, const ResultDirectory& directory) {
  Report report;
  report.title = "Experiment";
  report.arguments = arguments;
  report.options = options;
  report.summary = {{"object", record.object, "", Verdict::None, ""},
                    {"runs", std::to_string(record.runs), "", Verdict::None, "with different noise"}};
  if (record.interrupted) report.warnings.push_back("interrupted: the parts that had not ended are missing");
  for (const ExperimentSection& section : record.sections) {
    ReportSection shown{section.title, section.remarks, {}, {}, section.tables};
    int number = 0;
    for (const ReportTable& table : section.tables) {
      const std::string file = fmt::format("{}_{}.csv", section.name, ++number);
      directory.write_text(file, csv_of(table));
      report.links.push_back({file, table.title});
    }
    for (const ExperimentFigure& figure : section.figures) {
      const cv::Mat image = draw_plots(figure.plots, {960, 400});
      write_image(directory.path(figure.file), image);
      shown.figures.push_back({image, figure.caption, FigureFormat::Png});
    }
    for (const ExperimentScene& scene : section.scenes) {
      const auto image = drawn(scene, report);
      if (!image) continue;
      write_image(directory.path(scene.file), *image);
      shown.figures.push_back({*image, scene.caption, FigureFormat::Png});
    }
    report.sections.push_back(std::move(shown));
  }
  report.links.push_back({"summary.json", "all figures"});
  directory.write_text("options.yaml", options);
  write_report(directory.path("report.html"), report);
}

}  // namespace alidade
