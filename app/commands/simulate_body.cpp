// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/body_sequence_writer.h"
#include "app/body_simulation_report.h"
#include "app/commands/verbs.h"
#include "app/result_directory.h"
#include "datasets/body_scene.h"

namespace alidade {
namespace {

class SimulateBodyCommand : public Command {
 public:
  explicit SimulateBodyCommand(CLI::App&) {
    options_.add("frames", scene_.frames, "", "number of frames");
    options_.add("rate_hz", scene_.rate_hz, "Hz", "frames per second");
    options_.add("markers", scene_.markers, "", "of each body: 3, 4 or 8");
    options_.add("bodies", scene_.bodies, "", "number of bodies, which share the detectors");
    options_.add("blocks", scene_.blocks, "", "of four linear detectors");
    options_.add("sigma_rad", scene_.sigma_rad, "rad", "standard deviation of a reading");
    options_.add("wrong_ids", scene_.wrong_ids, "", "share of readings named after another marker of the same body");
    options_.add("occluded", scene_.occluded, "", "probability that a block does not see a marker");
    options_.add("redrawn", scene_.redrawn, "", "probability per frame that this is drawn anew");
    options_.add("skew_s", scene_.skew_s, "s", "time over which the readings of a frame are spread");
    options_.add_check([this] { validate(scene_); });
  }

  ExitCode run(const RunContext& context) override {
    BodySimulationRecord record;
    record.options = scene_;
    record.options.seed = context.seed;
    BodyScene scene(record.options);
    for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
      record.truth_files.push_back(truth_file(scene, i));
      record.body_names.push_back(scene.bodies()[i].name);
    }
    ResultDirectory directory(context.output, "simulate body");
    BodySequenceWriter writer(directory, scene);
    record.interrupted = !write_frames(context, scene, writer, record);
    writer.finish();
    directory.write_text("options.yaml", options_.to_yaml());
    write_report(directory.path("report.html"), report_of(record, context.arguments, options_.to_yaml()));
    const nlohmann::json summary = summary_of(record);
    directory.commit(summary);
    context.publish(summary);
    context.tell(fmt::format("{} frames with {} readings written to {}", record.frames, record.readings,
                             context.output.string()));
    return record.interrupted ? ExitCode::Interrupted : ExitCode::Success;
  }

 private:
  // False where the user stopped it.
  static bool write_frames(const RunContext& context, BodyScene& scene, BodySequenceWriter& writer,
                           BodySimulationRecord& record) {
    constexpr int kFramesPerReport = 250;
    while (const auto frame = scene.next()) {
      if (context.stop.stop_requested()) return false;
      std::vector<Eigen::Isometry3d> T_world_body;
      for (int i = 0; i < record.options.bodies; ++i) T_world_body.push_back(pose_in_scene(i, frame->time));
      writer.add(*frame, T_world_body);
      record.add(*frame, T_world_body);
      const bool is_last = record.frames == record.options.frames;
      if (is_last || record.frames % kFramesPerReport == 0) {
        context.progress({"reading markers", record.frames, record.options.frames, ""});
      }
    }
    return true;
  }

  BodySceneOptions scene_;
};

}  // namespace

Verb simulate_body_verb() {
  return {"simulate body", "rigid bodies read by blocks of linear detectors, with exact truth",
          "alidade simulate body --frames 2500 --wrong-ids 0.05 --occluded 0.3 -o body", OutputUse::Required,
          make_command<SimulateBodyCommand>};
}

}  // namespace alidade
