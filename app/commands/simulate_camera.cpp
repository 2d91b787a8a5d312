// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/result_directory.h"
#include "app/sequence_writer.h"
#include "app/simulation_report.h"
#include "datasets/rendered_scene.h"
#include "io/camera_file.h"

namespace alidade {
namespace {

class SimulateCameraCommand : public Command {
 public:
  explicit SimulateCameraCommand(CLI::App& flags) {
    flags.add_option("--camera", camera_file_,
                     "camera file, instead of --width, --height, --focal-px and --distortion-*");
    options_.add("frames", scene_.frames, "", "number of frames");
    options_.add("fps_hz", scene_.fps_hz, "Hz", "frames per second");
    options_.add_choice(
        "form", form_,
        {{"images", SequenceForm::Images}, {"movie", SequenceForm::Movie}, {"lossless", SequenceForm::Lossless}},
        "PNG images, an MP4 video, or an exact MKV video");
    options_.add("depth", depth_, "",
                 "depth images too: the output is a data set in the form of TUM's RGB-D benchmark");
    options_.add("width", width_, "px", "of the image");
    options_.add("height", height_, "px", "of the image");
    options_.add("focal_px", focal_px_, "px", "focal length; 0: 0.8125 of the width");
    options_.add("distortion.k1", lens_.k1, "", "radial, of Brown and Conrady's model");
    options_.add("distortion.k2", lens_.k2, "", "radial");
    options_.add("distortion.p1", lens_.p1, "", "tangential");
    options_.add("distortion.p2", lens_.p2, "", "tangential");
    options_.add("distortion.k3", lens_.k3, "", "radial");
    options_.add_choice("path", scene_.path,
                        {{"orbit", PathKind::Orbit},
                         {"sweep", PathKind::Sweep},
                         {"rotation", PathKind::Rotation},
                         {"stop-and-go", PathKind::StopAndGo}},
                        "how the camera moves; rotation: on the spot");
    options_.add("speed_m_s", scene_.speed_m_s, "m/s", "typical speed (of a rotation: rad/s)");
    options_.add("noise_grey", scene_.noise_grey, "grey levels", "standard deviation of the pixel noise");
    options_.add("exposure_s", scene_.exposure_s, "s", "time over which a frame is blurred");
    options_.add("supersampling", scene_.supersampling, "", "per side, against aliasing");
    options_.add("black_from", scene_.black_from, "", "first of black_count frames that show nothing");
    options_.add("black_count", scene_.black_count, "", "frames with the lens covered");
    options_.add("marker_m", scene_.marker_m, "m", "side of an AprilTag 36h11 on the table; 0: none");
    options_.add_check([this] { check(); });
  }

  ExitCode run(const RunContext& context) override {
    SimulationRecord record;
    record.options = effective_options();
    record.options.seed = context.seed;
    context.progress({"building the scene", 0, 0, ""});
    RenderedScene scene = open_scene(record.options);
    record.T_world_marker = scene.T_world_marker();
    ResultDirectory directory(context.output, "simulate camera");
    SequenceWriter writer(directory, scene.camera(), form_, record.options.fps_hz);
    record.interrupted = !write_frames(context, scene, writer, record);
    writer.finish();
    record.truth = writer.truth();
    directory.write_text("options.yaml", options_.to_yaml());
    write_report(directory.path("report.html"), report_of(record, context.arguments, options_.to_yaml()));
    const nlohmann::json summary = summary_of(record);
    directory.commit(summary);
    context.publish(summary);
    context.tell(fmt::format("{} frames written to {}", record.truth.size(), context.output.string()));
    return record.interrupted ? ExitCode::Interrupted : ExitCode::Success;
  }

 private:
  void check() const {
    if (depth_ && form_ != SequenceForm::Images) throw std::invalid_argument("depth must be written with form images");
    validate(effective_options());
  }

  RenderedSceneOptions effective_options() const {
    constexpr double kFocalPerWidth = 0.8125;  // 63 degrees across, as webcams have
    RenderedSceneOptions options = scene_;
    if (!camera_file_.empty()) {
      options.camera = read_camera(camera_file_);
      return options;
    }
    const double focal_px = focal_px_ == 0 ? kFocalPerWidth * width_ : focal_px_;
    options.camera = {width_, height_, focal_px, focal_px, 0.5 * (width_ - 1), 0.5 * (height_ - 1), lens_};
    return options;
  }

  // A lens that cannot be drawn is the user's fault too, and shows only now.
  RenderedScene open_scene(const RenderedSceneOptions& options) const try {
    return RenderedScene(options);
  } catch (const std::invalid_argument& error) {
    throw InputError(camera_file_.empty() ? "options" : camera_file_.string(), 0, error.what(),
                     "give a weaker distortion");
  }

  // False where the user stopped it.
  bool write_frames(const RunContext& context, RenderedScene& scene, SequenceWriter& writer,
                    SimulationRecord& record) const {
    constexpr int kFramesInReport = 4;
    const int count = scene.frame_count();
    for (int i = 0; i < count; ++i) {
      if (context.stop.stop_requested()) return false;
      const cv::Mat frame = scene.frame(i);
      std::optional<cv::Mat> depth;
      if (depth_) depth = scene.depth(i);
      writer.add(frame, {scene.time(i), scene.T_world_camera(i), std::nullopt}, depth);
      if (i % std::max(1, count / kFramesInReport) == 0) record.frames.push_back(frame);
      context.progress({"rendering", i + 1, count, ""});
    }
    return true;
  }

  std::filesystem::path camera_file_;
  RenderedSceneOptions scene_;
  SequenceForm form_ = SequenceForm::Images;
  bool depth_ = false;
  int width_ = 640, height_ = 480;
  BrownConrady lens_;
  double focal_px_ = 0;
};

}  // namespace

Verb simulate_camera_verb() {
  return {"simulate camera", "a textured room filmed along a path, with exact truth",
          "alidade simulate camera --frames 120 --noise-grey 3 -o scene", OutputUse::Required,
          make_command<SimulateCameraCommand>};
}

}  // namespace alidade
