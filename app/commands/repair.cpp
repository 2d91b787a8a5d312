// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/recording_checks.h"
#include "app/result_directory.h"
#include "capture/recording/recording_group.h"
#include "capture/recording/recording_repair.h"

namespace alidade {
namespace {

class RepairCommand : public Command {
 public:
  explicit RepairCommand(CLI::App& flags) {
    flags.add_option("RECORDING", folders_, "folders of recordings, of one camera or of several")->required();
  }

  ExitCode run(const RunContext& context) override {
    nlohmann::json list = nlohmann::json::array();
    for (const std::filesystem::path& folder : folders_) {
      for (const std::filesystem::path& recording : find_recordings(folder)) {
        const RecordingRepair repair = repair_recording(recording, context.progress);
        context.tell(line_of(recording, repair));
        list.push_back(summary_of(recording, repair));
      }
      refresh_recording_group(folder);
    }
    const nlohmann::json summary{{"recordings", std::move(list)}};
    context.publish(summary);
    if (!context.output.empty()) ResultDirectory(context.output, "repair").commit(summary);
    return ExitCode::Success;
  }

 private:
  std::vector<std::filesystem::path> folders_;
};

}  // namespace

Verb repair_verb() {
  return {"repair", "recordings that were interrupted, closed with every frame that they hold",
          "alidade repair recording", OutputUse::Optional, make_command<RepairCommand>};
}

}  // namespace alidade
