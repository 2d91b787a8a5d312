// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/targets/receiver_calibration_report.h"
#include "app/targets/receiver_calibration_summary.h"

namespace alidade {
namespace {

class CalibrateReceiversCommand : public Command {
 public:
  explicit CalibrateReceiversCommand(CLI::App& flags) {
    flags
        .add_option("RECEIVERS", sources_.receivers,
                    "receivers roughly known: our YAML, a rig of cameras, or a folder that holds observations too")
        ->required();
    flags.add_option("OBSERVATIONS", sources_.observations,
                     "CSV of the pixels of one flying target, by each receiver's own clock; may be left out with a "
                     "folder");
    flags.add_option("--truth", sources_.truth,
                     "where the target was: CSV of t_s, x_m, y_m, z_m, TUM, or a folder that holds it; without "
                     "it, path and cameras are found together");
    flags.add_option("--start-s", sources_.start_s, "s, by the common clock: pass over what is before");
    flags.add_option("--end-s", sources_.end_s, "s, by the common clock: pass over what is from there on");
    bind(options_, choice_);
  }

  ExitCode run(const RunContext& context) override {
    const ReceiverCalibrationInput input = read_calibration_input(sources_);
    ResultDirectory directory(context.output, "calibrate receivers");
    ReceiverCalibrationRun run = calibrate_receivers(input, choice_, {context.progress, context.stop});
    if (!run.has_answer()) {
      if (context.stop.stop_requested()) return ExitCode::Interrupted;
      context.warn(explain_no_answer(run));
      return ExitCode::NoAnswer;
    }
    add_warnings(run, choice_);
    write_calibration(run, directory, context.arguments, options_.to_yaml());
    for (const std::string& warning : run.warnings) context.warn(warning);
    const nlohmann::json summary = summary_of(run);
    directory.commit(summary);
    context.publish(summary);
    for (const std::string& line : table_lines(run)) context.tell(line);
    context.tell(fmt::format("written to {}", context.output.string()));
    return context.stop.stop_requested() ? ExitCode::Interrupted : ExitCode::Success;
  }

 private:
  ReceiverCalibrationSources sources_;
  ReceiverCalibrationChoice choice_;
};

}  // namespace

Verb calibrate_receivers_verb() {
  return {"calibrate receivers", "poses and clocks of cameras that watch the sky, from one flying target",
          "alidade calibrate receivers receivers.yaml observations.csv --truth path.csv -o calibration",
          OutputUse::Required, make_command<CalibrateReceiversCommand>};
}

}  // namespace alidade
