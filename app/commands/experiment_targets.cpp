// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands/verbs.h"
#include "app/experiments/experiment_report.h"
#include "app/experiments/targets_experiment.h"
#include "core/errors.h"

namespace alidade {
namespace {

struct Part {
  std::string name;
  ExperimentSection (*run)(const ExperimentContext&);
};

const std::vector<Part> kParts{
    {"tables", targets_tables}, {"formulas", targets_formulas},   {"batch", targets_batch},
    {"window", targets_window}, {"placement", targets_placement}, {"tracker", targets_tracker},
    {"cue", targets_cue},       {"video", targets_video},
};

constexpr const char* kRecording = "recording";  // on the user's flight: run where its folder is given

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const Part& part : kParts) names.push_back(part.name);
  names.push_back(kRecording);
  return names;
}

class ExperimentTargetsCommand : public Command {
 public:
  explicit ExperimentTargetsCommand(CLI::App& flags) {
    flags.add_option("--recording", recording_, "folder of a flight with truth, for recording");
    flags.add_option("--only", only_, fmt::format("parts to run: {}", fmt::join(part_names(), ", ")))
        ->check(CLI::IsMember(part_names()));
    options_.add("runs", runs_, "", "of each condition");
    options_.add_check([this] {
      constexpr int kFewest = 10;
      if (runs_ < kFewest) throw std::invalid_argument(fmt::format("runs must be >= {}, got {}", kFewest, runs_));
    });
  }

  ExitCode run(const RunContext& context) override {
    if (recording_.empty() && !only_.empty() && is_wanted(kRecording)) {
      throw InputError(fmt::format("--only {}", kRecording), 0, "needs a recording", "give it with --recording FOLDER");
    }
    const ExperimentContext experiment{runs_, context.seed, context.progress, context.stop};
    ExperimentRecord record{"the scene of the UAV paper's page", "runs", runs_, false, {}};
    const auto take = [&](const std::string& name, const auto& run) {
      if (!is_wanted(name) || context.stop.stop_requested()) return;
      ExperimentSection section = run();
      if (context.stop.stop_requested()) return;  // a part that was cut short proves nothing
      tell(section, context);
      record.sections.push_back(std::move(section));
    };
    for (const Part& part : kParts) take(part.name, [&] { return part.run(experiment); });
    if (!recording_.empty()) take(kRecording, [&] { return targets_recording(recording_, experiment); });
    record.interrupted = context.stop.stop_requested();
    return finish(record, "experiment targets", options_.to_yaml(), context);
  }

 private:
  bool is_wanted(const std::string& name) const {
    return only_.empty() || std::find(only_.begin(), only_.end(), name) != only_.end();
  }

  std::filesystem::path recording_;
  std::vector<std::string> only_;
  int runs_ = 300;
};

}  // namespace

Verb experiment_targets_verb() {
  return {"experiment targets", "the UAV paper's tables, and ours and the bound beside them",
          "alidade experiment targets -o experiment\n"
          "alidade experiment targets --only tables --runs 1000\n"
          "alidade experiment targets --only recording --recording uav -o experiment",
          OutputUse::Optional, make_command<ExperimentTargetsCommand>};
}

}  // namespace alidade
