// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/result_directory.h"
#include "app/targets/simulation_options.h"
#include "app/targets/simulation_report.h"
#include "io/receiver_file.h"
#include "io/receiver_reading_file.h"

namespace alidade {
namespace {

class SimulateTargetsCommand : public Command {
 public:
  explicit SimulateTargetsCommand(CLI::App&) { bind(options_, simulation_); }

  ExitCode run(const RunContext& context) override {
    TargetSceneOptions options = scene_of(simulation_);
    options.seed = context.seed;
    const TargetScene scene = make_target_scene(options);
    const std::vector<TargetRow> truth = truth_of(scene, simulation_.truth_rate_hz);
    ResultDirectory directory(context.output, "simulate targets");
    write_receivers(directory.path("receivers.yaml"), scene.receivers);
    ReceiverReadingWriter readings(directory.path("observations.csv"), scene.receivers);
    for (const ReceiverReading& reading : scene.readings) readings.write(reading);
    readings.commit();
    TargetFileWriter rows(directory.path("truth.csv"));
    for (const TargetRow& row : truth) rows.write(row);
    rows.commit();
    directory.write_text("options.yaml", options_.to_yaml());
    Report report = report_of(options, scene, truth, context.arguments);
    report.options = options_.to_yaml();
    write_report(directory.path("report.html"), report);
    for (const std::string& warning : report.warnings) context.warn(warning);
    const nlohmann::json summary = summary_of(options, scene);
    directory.commit(summary);
    context.publish(summary);
    context.tell(fmt::format("{} bearings of {} targets written to {}", scene.readings.size(), options.targets,
                             context.output.string()));
    return ExitCode::Success;
  }

 private:
  TargetSimulationOptions simulation_;
};

}  // namespace

Verb simulate_targets_verb() {
  return {"simulate targets", "flying objects seen by receivers that look at different times, with exact truth",
          "alidade simulate targets --targets 5 --false-bearings 1 --detection-probability 0.9 -o flight\n"
          "alidade simulate targets --periods 60 --scan-law rotating -o scans",
          OutputUse::Required, make_command<SimulateTargetsCommand>};
}

}  // namespace alidade
