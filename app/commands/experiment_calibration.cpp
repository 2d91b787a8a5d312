// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <fmt/format.h>

#include "app/commands/verbs.h"
#include "app/experiments/calibration_experiment.h"
#include "app/experiments/experiment_report.h"

namespace alidade {
namespace {

class ExperimentCalibrationCommand : public Command {
 public:
  explicit ExperimentCalibrationCommand(CLI::App& flags) {
    flags.add_option("--images", source_,
                     "images of a board: their two halves are calibrated and compared, instead of rendered sets");
    flags.add_option("--board", board_, "of --images, as of calibrate camera; left out: guessed");
    options_.add("sets", sets_, "", "of rendered images");
    options_.add_check([this] {
      if (sets_ < 1) throw std::invalid_argument(fmt::format("sets must be >= 1, got {}", sets_));
    });
  }

  ExitCode run(const RunContext& context) override {
    const ExperimentContext experiment{sets_, context.seed, context.progress, context.stop};
    ExperimentRecord record{source_.empty() ? "rendered boards" : source_, "sets", sets_, false, {}};
    ExperimentSection section =
        source_.empty() ? calibration_coverage(experiment) : calibration_halves(source_, board_, experiment);
    if (!context.stop.stop_requested()) {
      tell(section, context);
      record.sections.push_back(std::move(section));
    }
    record.interrupted = context.stop.stop_requested();
    return finish(record, "experiment calibration", options_.to_yaml(), context);
  }

 private:
  std::string source_, board_;
  int sets_ = 300;
};

}  // namespace

Verb experiment_calibration_verb() {
  return {"experiment calibration", "whether calibrations of cameras are as good as they say",
          "alidade experiment calibration -o experiment\n"
          "alidade experiment calibration --images 'shots/*.jpg' --board chessboard:9x6:25mm",
          OutputUse::Optional, make_command<ExperimentCalibrationCommand>};
}

}  // namespace alidade
