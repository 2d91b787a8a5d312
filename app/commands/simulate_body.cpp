// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/body_sequence_writer.h"
#include "app/body_simulation_report.h"
#include "app/commands/verbs.h"
#include "app/result_directory.h"
#include "datasets/line_image_files.h"
#include "marker1d/blink_code.h"

namespace alidade {
namespace {

constexpr int kRowsPerPart = 512;  // of line images

// What lenses read of spots that stand alone.
BodySceneOptions as_seen_in_images(BodySceneOptions scene, const LineImageLook& look) {
  scene.has_lenses = true;
  scene.sigma_px = lone_spot_bound_px(look);
  return scene;
}

class SimulateBodyCommand : public Command {
 public:
  explicit SimulateBodyCommand(CLI::App&) {
    options_.add("frames", scene_.frames, "", "number of frames");
    options_.add("rate_hz", scene_.rate_hz, "Hz", "frames per second");
    options_.add("markers", scene_.markers, "", "of each body: 3, 4 or 8");
    options_.add("bodies", scene_.bodies, "", "number of bodies, which share the detectors");
    options_.add("blocks", scene_.blocks, "", "of four linear detectors");
    options_.add("sigma_rad", scene_.sigma_rad, "rad", "standard deviation of a reading");
    options_.add("lenses", scene_.has_lenses, "", "detectors are lines of pixels behind lenses, and read px");
    options_.add("sigma_px", scene_.sigma_px, "px", "standard deviation of a reading by them");
    options_.add("wrong_ids", scene_.wrong_ids, "", "share of readings named after another marker of the same body");
    options_.add("occluded", scene_.occluded, "", "probability that a block does not see a marker");
    options_.add("redrawn", scene_.redrawn, "", "probability per frame that this is drawn anew");
    options_.add("skew_s", scene_.skew_s, "s", "time over which the readings of a frame are spread");
    options_.add("line_images", has_images_, "", "what the pixels see: a row each frame, of blinking markers");
    options_.add("snr", look_.snr, "", "of line images: height of a spot over the noise of its highest pixel");
    options_.add_check([this] {
      validate(scene_);
      if (has_images_) image_scene();
    });
  }

  ExitCode run(const RunContext& context) override {
    scene_.seed = context.seed;
    if (has_images_) scene_ = as_seen_in_images(scene_, look_);
    const BodyScene scene(scene_);
    BodySimulationRecord record;
    record.options = scene_;
    for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
      record.truth_files.push_back(truth_file(scene.bodies(), i));
      record.body_names.push_back(scene.bodies()[i].name);
    }
    ResultDirectory directory(context.output, "simulate body");
    BodySequenceWriter writer(directory, scene.detectors(), scene.bodies());
    const auto take = [&](const BodySceneFrame& frame) { add(frame, context, writer, record); };
    record.interrupted = !(has_images_ ? draw(context, directory, take, record) : read(context, scene, take));
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
  using FrameSink = std::function<void(const BodySceneFrame&)>;

  LineImageScene image_scene() const {
    return line_image_scene(scene_, blink_codes(scene_.bodies * scene_.markers), look_);
  }

  // False where the user stopped it, as below.
  static bool read(const RunContext& context, BodyScene scene, const FrameSink& take) {
    while (const auto frame = scene.next()) {
      if (context.stop.stop_requested()) return false;
      take(*frame);
    }
    return true;
  }

  // Images, and beside them what would be read of lit markers by an observer who errs no more than he must.
  bool draw(const RunContext& context, const ResultDirectory& directory, const FrameSink& take,
            BodySimulationRecord& record) const {
    const LineImageScene scene = image_scene();
    LineImageFilesWriter images(scene, directory.path("line_images/lines.yaml").parent_path());
    LineImageRecording recording(scene);
    std::seed_seq stream{context.seed, 9u};
    std::mt19937_64 random(stream);
    bool is_whole = true;
    while (const auto block = recording.next(kRowsPerPart)) {
      images.write(*block);
      if (record.line_image.empty()) record.line_image = block->images.front();
      for (const BodySceneFrame& frame : block->frames) take(disturbed(frame, random));
      is_whole = !context.stop.stop_requested();
      if (!is_whole) break;
    }
    images.commit();
    return is_whole;
  }

  static void add(const BodySceneFrame& frame, const RunContext& context, BodySequenceWriter& writer,
                  BodySimulationRecord& record) {
    constexpr int kFramesPerReport = 250;
    std::vector<Eigen::Isometry3d> T_world_body;
    for (int i = 0; i < record.options.bodies; ++i) T_world_body.push_back(pose_in_scene(i, frame.time));
    writer.add(frame, T_world_body);
    record.add(frame, T_world_body);
    const bool is_last = record.frames == record.options.frames;
    if (is_last || record.frames % kFramesPerReport == 0) {
      context.progress({"reading markers", record.frames, record.options.frames, ""});
    }
  }

  BodySceneOptions scene_;
  LineImageLook look_;
  bool has_images_ = false;
};

}  // namespace

Verb simulate_body_verb() {
  return {"simulate body", "rigid bodies read by blocks of linear detectors, with exact truth",
          "alidade simulate body --frames 2500 --wrong-ids 0.05 --occluded 0.3 -o body\n"
          "alidade simulate body --frames 1000 --line-images --snr 10 -o lines",
          OutputUse::Required, make_command<SimulateBodyCommand>};
}

}  // namespace alidade
