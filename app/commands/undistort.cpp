// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/camera_source.h"
#include "app/commands/verbs.h"
#include "app/undistorted_sequence.h"
#include "app/undistortion_report.h"
#include "capture/file_sources.h"
#include "capture/undistortion.h"
#include "io/video_reader.h"

namespace alidade {
namespace {

enum class Form { AsSource, Images, Movie, Lossless };

class UndistortCommand : public Command {
 public:
  explicit UndistortCommand(CLI::App& flags) {
    flags.add_option("SOURCE", source_, "video, folder or glob of images, or data set folder")->required();
    flags.add_option("--camera", camera_file_, "the calibration, of any known format; default: the data set's");
    flags.add_option("--fps", fps_hz_, "frames per second of images that have no times")->check(CLI::PositiveNumber);
    options_.add("alpha", undistortion_.alpha, "", "0: only what the lens saw, 1: all that it saw, with black around");
    options_.add("focal_px", undistortion_.focal_px, "px", "of the new camera; 0: by alpha");
    options_.add_choice(
        "form", form_,
        {{"as-source", Form::AsSource}, {"images", Form::Images}, {"movie", Form::Movie}, {"lossless", Form::Lossless}},
        "what to write; as-source: images for images, a movie for a video");
    options_.add_check([this] { validate(undistortion_); });
  }

  ExitCode run(const RunContext& context) override {
    CameraSource source = open_camera_source(source_, camera_file_, fps_hz_);
    UndistortionRecord record;
    record.source = source.frames->describe();
    record.camera = source.camera;
    record.pinhole = find_pinhole(source.camera);
    ResultDirectory directory(context.output, "undistort");
    UndistortedSequence sequence(directory, record.pinhole, form(), frame_rate_hz());
    undistort_all(context, source, sequence, record);
    if (const auto fault = source.frames->fault()) record.warnings.push_back(*fault);
    for (const std::string& warning : record.warnings) context.warn(warning);
    sequence.finish(source.frames->has_times());
    directory.write_text("options.yaml", options_.to_yaml());
    write_report(directory.path("report.html"), report_of(record, context.arguments, options_.to_yaml()));
    directory.commit(summary_of(record));
    context.publish(summary_of(record));
    context.tell(fmt::format("{} frames written to {}", record.frames, context.output.string()));
    return record.interrupted ? ExitCode::Interrupted : ExitCode::Success;
  }

 private:
  Camera find_pinhole(const Camera& camera) const {
    if (const auto pinhole = undistorted_camera(camera, undistortion_)) return *pinhole;
    throw InputError(
        camera_file_.empty() ? source_ : camera_file_.string(), 0,
        "a pixel at the border looks 80 degrees or more off axis, or has no ray: no pinhole image shows all",
        "set --focal-px, or --alpha 0");
  }

  void undistort_all(const RunContext& context, CameraSource& source, UndistortedSequence& sequence,
                     UndistortionRecord& record) const {
    const UndistortionMap map = undistortion_map(source.camera, record.pinhole);
    const int total = source.frames->frame_count().value_or(0);
    while (const auto frame = next_image(source)) {
      if (context.stop.stop_requested()) {
        record.interrupted = true;
        return;
      }
      context.progress({"undistorting", frame->index + 1, total, ""});
      const cv::Mat& image = frame->colour.empty() ? frame->grey : frame->colour;
      const cv::Mat undistorted = undistorted_image(image, map);
      const bool of_video = is_video_name(source_);
      sequence.add(of_video ? fmt::format("{:06}.png", frame->index) : frame->name, frame->time, undistorted);
      if (record.frames++ == 0) {
        record.before = image;
        record.after = undistorted;
      }
    }
  }

  SequenceForm form() const {
    if (form_ == Form::AsSource) return is_video_name(source_) ? SequenceForm::Movie : SequenceForm::Images;
    if (form_ == Form::Images) return SequenceForm::Images;
    return form_ == Form::Movie ? SequenceForm::Movie : SequenceForm::Lossless;
  }

  // Of a video that is written.
  double frame_rate_hz() const {
    if (fps_hz_) return *fps_hz_;
    constexpr double kUsual = 30.0;
    return is_video_name(source_) ? VideoReader(source_).facts().fps_hz.value_or(kUsual) : kUsual;
  }

  std::string source_;
  std::filesystem::path camera_file_;
  std::optional<double> fps_hz_;
  UndistortionOptions undistortion_;
  Form form_ = Form::AsSource;
};

}  // namespace

Verb undistort_verb() {
  return {"undistort", "images or a video as a camera without distortion would have taken them",
          "alidade undistort walk.mp4 --camera camera.yaml -o straight", OutputUse::Required,
          make_command<UndistortCommand>};
}

}  // namespace alidade
