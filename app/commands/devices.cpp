// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/camera_listing_text.h"
#include "app/commands/verbs.h"
#include "app/listed_cameras.h"
#include "app/result_directory.h"

namespace alidade {
namespace {

class DevicesCommand : public Command {
 public:
  explicit DevicesCommand(CLI::App& flags) {
    flags.add_option("SOURCE", sources_, "cameras to tell everything of: v4l2:/dev/video0, genicam:192.168.0.7");
  }

  ExitCode run(const RunContext& context) override {
    const std::vector<ListedCamera> cameras = sources_.empty() ? list_cameras() : describe_cameras(sources_);
    nlohmann::json list = nlohmann::json::array();
    for (const ListedCamera& camera : cameras) {
      for (const std::string& line : lines_of(camera, !sources_.empty())) context.tell(line);
      list.push_back(to_json(camera));
    }
    const nlohmann::json summary{{"cameras", std::move(list)}};
    context.publish(summary);
    if (!context.output.empty()) ResultDirectory(context.output, "devices").commit(summary);
    if (!cameras.empty()) return ExitCode::Success;
    context.warn(
        "no camera was found: V4L2 cameras are /dev/video*, GigE cameras answer on the networks of this host "
        "(name one that does not: alidade devices genicam:ADDRESS)");
    return ExitCode::NoAnswer;
  }

 private:
  std::vector<std::string> sources_;
};

}  // namespace

Verb devices_verb() {
  return {"devices", "the cameras that are there: formats, rates, controls",
          "alidade devices\nalidade devices genicam:192.168.0.7", OutputUse::Optional, make_command<DevicesCommand>};
}

}  // namespace alidade
