// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/experiment_report.h"

#include <fmt/format.h>

#include "app/result_directory.h"
#include "app/scene_picture.h"
#include "io/image_files.h"
#include "view/report.h"

namespace alidade {
namespace {

void write_experiment(const ExperimentRecord& record, const std::vector<std::string>& arguments,
                      const std::string& options, const ResultDirectory& directory) {
  Report report;
  report.title = "Experiment";
  report.arguments = arguments;
  report.options = options;
  report.summary = {{"object", record.object, "", Verdict::None, ""},
                    {record.unit, std::to_string(record.count), "", Verdict::None, "of each condition"}};
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
      const auto image = draw_scene(track_scene(scene.picture), {}, scene.file, report.warnings);
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

}  // namespace

nlohmann::json summary_of(const ExperimentRecord& record) {
  nlohmann::json summary;
  summary["object"] = record.object;
  summary[record.unit] = record.count;
  summary["interrupted"] = record.interrupted;
  for (const ExperimentSection& section : record.sections) summary[section.name] = section.summary;
  return summary;
}

void tell(const ExperimentSection& section, const RunContext& context) {
  for (const ReportTable& table : section.tables) {
    for (const std::string& line : lines_of(table)) context.tell(line);
    context.tell("");
  }
  for (const std::string& remark : section.remarks) context.tell(remark);
}

ExitCode finish(const ExperimentRecord& record, const std::string& verb, const std::string& options,
                const RunContext& context) {
  const nlohmann::json summary = summary_of(record);
  context.publish(summary);
  if (!context.output.empty()) {
    ResultDirectory directory(context.output, verb);
    write_experiment(record, context.arguments, options, directory);
    directory.commit(summary);
    context.tell(fmt::format("written to {}", context.output.string()));
  }
  return record.interrupted ? ExitCode::Interrupted : ExitCode::Success;
}

}  // namespace alidade
