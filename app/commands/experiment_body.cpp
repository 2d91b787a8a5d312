// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands/verbs.h"
#include "app/experiments/body_experiment.h"
#include "app/experiments/experiment_report.h"

namespace alidade {
namespace {

struct Part {
  std::string name;
  ExperimentSection (*run)(const ExperimentContext&);
};

const std::vector<Part> kParts{{"accuracy", body_accuracy},   {"wrong-ids", body_wrong_ids},
                               {"occlusion", body_occlusion}, {"solvers", body_solvers},
                               {"start", body_start},         {"lines", body_lines},
                               {"speed", body_speed}};

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const Part& part : kParts) names.push_back(part.name);
  return names;
}

class ExperimentBodyCommand : public Command {
 public:
  explicit ExperimentBodyCommand(CLI::App& flags) {
    flags.add_option("--only", only_, fmt::format("parts to run: {}", fmt::join(part_names(), ", ")))
        ->check(CLI::IsMember(part_names()));
    options_.add("frames", frames_, "", "of each condition, or starts");
    options_.add_check([this] {
      constexpr int kFewest = 100;
      if (frames_ < kFewest) {
        throw std::invalid_argument(fmt::format("frames must be >= {}, got {}", kFewest, frames_));
      }
    });
  }

  ExitCode run(const RunContext& context) override {
    const ExperimentContext experiment{frames_, context.seed, context.progress, context.stop};
    ExperimentRecord record{"the scene of the 1D-marker paper's page", "frames", frames_, false, {}};
    for (const Part& part : kParts) {
      if (!only_.empty() && std::find(only_.begin(), only_.end(), part.name) == only_.end()) continue;
      ExperimentSection section = part.run(experiment);
      if (context.stop.stop_requested()) break;  // a part that was cut short proves nothing
      tell(section, context);
      record.sections.push_back(std::move(section));
    }
    record.interrupted = context.stop.stop_requested();
    return finish(record, "experiment body", options_.to_yaml(), context);
  }

 private:
  std::vector<std::string> only_;
  int frames_ = 10000;
};

}  // namespace

Verb experiment_body_verb() {
  return {"experiment body", "the 1D-marker paper's experiments, and ours beside them",
          "alidade experiment body -o experiment\n"
          "alidade experiment body --only start --frames 2000",
          OutputUse::Optional, make_command<ExperimentBodyCommand>};
}

}  // namespace alidade
