// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/result_directory.h"
#include "app/targets/simulation_options.h"
#include "app/targets/simulation_report.h"
#include "datasets/sky_video_files.h"
#include "io/receiver_file.h"
#include "io/receiver_reading_file.h"

namespace alidade {
namespace {

// Simulated receivers stand where they are said to, and say so: else those who read them would allow for errors.
std::vector<Receiver> as_exact(std::vector<Receiver> receivers) {
  constexpr double kVariance = 1e-12;  // a micrometre, a microradian
  for (Receiver& receiver : receivers) receiver.pose_covariance = kVariance * Matrix6d::Identity();
  return receivers;
}

class SimulateTargetsCommand : public Command {
 public:
  explicit SimulateTargetsCommand(CLI::App&) { bind(options_, simulation_); }

  ExitCode run(const RunContext& context) override {
    ResultDirectory directory(context.output, "simulate targets");
    return simulation_.has_videos ? film(context, directory) : observe(context, directory);
  }

 private:
  ExitCode observe(const RunContext& context, ResultDirectory& directory) const {
    TargetSceneOptions options = scene_of(simulation_);
    options.seed = context.seed;
    const TargetScene scene = make_target_scene(options);
    const std::vector<TargetRow> truth = truth_of(scene, simulation_.truth_rate_hz);
    ReceiverReadingWriter readings(directory.path("observations.csv"), scene.receivers);
    for (const ReceiverReading& reading : scene.readings) readings.write(reading);
    readings.commit();
    finish(context, directory, scene.receivers, truth, report_of(options, scene, truth, context.arguments),
           summary_of(options, scene));
    context.tell(fmt::format("{} bearings of {} targets written to {}", scene.readings.size(), options.targets,
                             context.output.string()));
    return ExitCode::Success;
  }

  ExitCode film(const RunContext& context, ResultDirectory& directory) const {
    SkySceneOptions options = sky_of(simulation_);
    options.seed = options.look.seed = options.look.backdrop.seed = context.seed;
    const SkyScene scene = make_sky_scene(options);
    const std::vector<TargetRow> truth = truth_of(scene.paths, simulation_.truth_rate_hz, options.duration_s);
    const std::vector<std::string> videos =
        write_sky_videos(scene, directory.path("truth.csv").parent_path(), context.progress, context.stop);
    nlohmann::json summary = summary_of(options, scene, videos);
    summary["interrupted"] = context.stop.stop_requested();
    finish(context, directory, scene.receivers, truth, report_of(scene, truth, videos, context.arguments), summary);
    context.tell(fmt::format("{} videos of {} targets written to {}", videos.size(), scene.paths.size(),
                             context.output.string()));
    return context.stop.stop_requested() ? ExitCode::Interrupted : ExitCode::Success;
  }

  void finish(const RunContext& context, ResultDirectory& directory, const std::vector<Receiver>& receivers,
              const std::vector<TargetRow>& truth, Report report, const nlohmann::json& summary) const {
    write_receivers(directory.path("receivers.yaml"), as_exact(receivers));
    TargetFileWriter rows(directory.path("truth.csv"));
    for (const TargetRow& row : truth) rows.write(row);
    rows.commit();
    directory.write_text("options.yaml", options_.to_yaml());
    report.options = options_.to_yaml();
    write_report(directory.path("report.html"), report);
    for (const std::string& warning : report.warnings) context.warn(warning);
    directory.commit(summary);
    context.publish(summary);
  }

  TargetSimulationOptions simulation_;
};

}  // namespace

Verb simulate_targets_verb() {
  return {"simulate targets", "flying objects seen by receivers that look at different times, with exact truth",
          "alidade simulate targets --targets 5 --false-bearings 1 --detection-probability 0.9 -o flight\n"
          "alidade simulate targets --periods 60 --scan-law rotating -o scans\n"
          "alidade simulate targets --targets 3 --videos -o films",
          OutputUse::Required, make_command<SimulateTargetsCommand>};
}

}  // namespace alidade
