// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands/verbs.h"
#include "app/experiments/experiment_report.h"
#include "app/experiments/targets_experiment.h"

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

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const Part& part : kParts) names.push_back(part.name);
  return names;
}

class ExperimentTargetsCommand : public Command {
 public:
  explicit ExperimentTargetsCommand(CLI::App& flags) {
    flags.add_option("--only", only_, fmt::format("parts to run: {}", fmt::join(part_names(), ", ")))
        ->check(CLI::IsMember(part_names()));
    options_.add("runs", runs_, "", "of each condition");
    options_.add_check([this] {
      constexpr int kFewest = 10;
      if (runs_ < kFewest) throw std::invalid_argument(fmt::format("runs must be >= {}, got {}", kFewest, runs_));
    });
  }

  ExitCode run(const RunContext& context) override {
    const ExperimentContext experiment{runs_, context.seed, context.progress, context.stop};
    ExperimentRecord record{"the scene of the UAV paper's page", "runs", runs_, false, {}};
    for (const Part& part : kParts) {
      if (!only_.empty() && std::find(only_.begin(), only_.end(), part.name) == only_.end()) continue;
      ExperimentSection section = part.run(experiment);
      if (context.stop.stop_requested()) break;  // a part that was cut short proves nothing
      tell(section, context);
      record.sections.push_back(std::move(section));
    }
    record.interrupted = context.stop.stop_requested();
    return finish(record, "experiment targets", options_.to_yaml(), context);
  }

 private:
  std::vector<std::string> only_;
  int runs_ = 300;
};

}  // namespace

Verb experiment_targets_verb() {
  return {"experiment targets", "the UAV paper's tables, and ours and the bound beside them",
          "alidade experiment targets -o experiment\n"
          "alidade experiment targets --only tables --runs 1000",
          OutputUse::Optional, make_command<ExperimentTargetsCommand>};
}

}  // namespace alidade
