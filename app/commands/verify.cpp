// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/recording_checks.h"
#include "app/result_directory.h"
#include "capture/recording/recording_verification.h"

namespace alidade {
namespace {

class VerifyCommand : public Command {
 public:
  explicit VerifyCommand(CLI::App& flags) {
    flags.add_option("RECORDING", folders_, "folders of recordings, of one camera or of several")->required();
  }

  ExitCode run(const RunContext& context) override {
    nlohmann::json list = nlohmann::json::array();
    std::vector<VerifiedRecording> damaged;
    for (const std::filesystem::path& folder : folders_) {
      for (const std::filesystem::path& recording : find_recordings(folder)) {
        VerifiedRecording verified{recording, verify_recording(recording, context.progress)};
        for (const std::string& line : lines_of(verified)) context.tell(line);
        list.push_back(summary_of(verified));
        if (!verified.result.faults.empty()) damaged.push_back(std::move(verified));
      }
    }
    const nlohmann::json summary{{"recordings", std::move(list)}};
    context.publish(summary);
    if (!context.output.empty()) ResultDirectory(context.output, "verify").commit(summary);
    if (!damaged.empty()) throw error_of(damaged);
    return ExitCode::Success;
  }

 private:
  std::vector<std::filesystem::path> folders_;
};

}  // namespace

Verb verify_verb() {
  return {"verify", "whether recordings are still what was recorded", "alidade verify recording", OutputUse::Optional,
          make_command<VerifyCommand>};
}

}  // namespace alidade
