// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "app/board_images.h"
#include "app/camera_options.h"
#include "app/capture_record.h"
#include "app/capture_warnings.h"
#include "app/commands/verbs.h"
#include "app/frame_sources.h"
#include "calib/boards/board_detection.h"
#include "io/image_files.h"

namespace alidade {
namespace {

class GuideCommand : public Command {
 public:
  explicit GuideCommand(CLI::App& flags) {
    flags
        .add_option(
            "SOURCE", source_,
            "where somebody shows a board: v4l2:/dev/video0, genicam:ADDRESS, a video, a folder, a glob in quotes")
        ->required();
    flags.add_option("--board", board_, "e.g. chessboard:9x6:25mm (inner corners); left out: guessed");
    flags.add_option("--fps", fps_hz_, "frames per second of images that have no times")->check(CLI::PositiveNumber);
    flags.add_flag("--stream", stream_, "what to show of every frame as JSON lines on standard output, at once");
    options_.add_choice("lens", guide_.lens,
                        {{"radial", LensModel::Radial},
                         {"brown", LensModel::Brown},
                         {"rational", LensModel::Rational},
                         {"fisheye", LensModel::Fisheye}},
                        "of the quick calibrations on the way");
    options_.add("enough_px", guide_.enough_px, "px", "uncertainty of pixels, anywhere in the image, to stop at");
    options_.add("still_s", guide_.still_s, "s",
                 "for so long a board has to rest; 0: every image is a photograph, as where they have no times");
    options_.add("still_share", guide_.still_share, "", "of the image's width: by no more a resting board moves");
    options_.add("distinct_share", guide_.distinct_share, "", "of the image's width: by so much views have to differ");
    options_.add("least_tilt_deg", guide_.coverage.least_tilt_deg, "deg", "that counts as tilted");
    bind(options_, flags, camera_);
    options_.add_check([this] { validate(guide_); });
  }

  ExitCode run(const RunContext& context) override {
    CaptureRecord record;
    const auto frames = open_frames(source_, camera_, warn_of_news(context), fps_hz_);
    record.board =
        (is_camera_name(source_) ? choose_board(board_, source_, *frames) : choose_board(board_, source_)).board;
    record.enough_px = guide_.enough_px;
    record.source = frames->describe();
    ResultDirectory directory(context.output, "guide");
    lead(context, *frames, directory, record);
    if (record.accepted.empty() && !record.interrupted) refuse(record);
    if (const auto fault = frames->fault()) record.warnings.push_back(*fault);
    if (!record.last.is_enough && !record.interrupted) {
      record.warnings.push_back(
          fmt::format("the views are not enough yet: {}", fmt::join(missing_words(record), "; ")));
    }
    for (const std::string& warning : record.warnings) context.warn(warning);
    write_views(record, directory);
    directory.write_text("options.yaml", options_.to_yaml());
    write_report(directory.path("report.html"), report_of(record, context.arguments, options_.to_yaml()));
    directory.commit(summary_of(record));
    context.publish(summary_of(record));
    tell(context, fmt::format("{} images written to {}", record.accepted.size(), context.output.string()));
    return record.interrupted ? ExitCode::Interrupted : ExitCode::Success;
  }

 private:
  // Until it is enough, the frames end, or the user stops it.
  void lead(const RunContext& context, FrameSource& frames, const ResultDirectory& directory,
            CaptureRecord& record) const {
    CaptureGuideOptions options = guide_;
    if (!frames.has_times()) options.still_s = 0;
    std::optional<CaptureGuide> guide;
    while (!record.last.is_enough) {
      const auto frame = frames.next(context.stop);
      if ((record.interrupted = context.stop.stop_requested()) || !frame) break;
      if (!guide) {
        record.image = {frame->image.cols, frame->image.rows};
        guide.emplace(record.board, record.image, options);
      }
      const double time_s = to_seconds(frame->time.time_since_epoch());
      const auto view = find_board(frame->image, record.board);
      record.last = guide->see(view, time_s);
      record.boards += view.has_value();
      ++record.frames;
      if (record.last.state == CaptureState::Accepted) keep(context, *frame, directory, record);
      if (stream_) context.stream(guide_event(frame->index, time_s, record.last));
      context.progress({"watching", record.frames, frames.frame_count().value_or(0), ""});
    }
    if (guide) record.stances = guide->stances();
  }

  static std::optional<BoardView> find_board(const cv::Mat& image, const Board& board) {
    if (image.channels() == 1) return detect_board(image, board);
    cv::Mat grey;
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    return detect_board(grey, board);
  }

  void keep(const RunContext& context, const Frame& frame, const ResultDirectory& directory,
            CaptureRecord& record) const {
    const std::string file = fmt::format("images/{:06}.png", frame.index);
    write_image(directory.path(file), frame.image);
    record.accepted.push_back({file, frame.index, frame.time});
    record.sample = frame.image;
    const GuideStep& step = record.last;
    const std::string next = step.is_enough ? "that is enough" : step.wish ? describe(*step.wish, record.image) : "";
    tell(context, fmt::format("view {} taken ({}); {}", step.accepted, frame.name, next));
  }

  // With --stream standard output is for the frames alone.
  void tell(const RunContext& context, const std::string& line) const {
    if (!stream_) context.tell(line);
  }

  [[noreturn]] void refuse(const CaptureRecord& record) const {
    if (record.boards == 0) {
      throw InputError(source_, 0, fmt::format("no {} in any of {} frames", describe(record.board), record.frames),
                       "check --board, and that the whole board is in the image, sharp and evenly lit");
    }
    throw InputError(source_, 0, fmt::format("the board never rests for {} s", guide_.still_s),
                     "hold it still after each move; for single photographs give --still-s 0");
  }

  std::string source_, board_;
  std::optional<double> fps_hz_;
  bool stream_ = false;
  CaptureGuideOptions guide_;
  CameraOptions camera_;
};

}  // namespace

Verb guide_verb() {
  return {"guide", "which view of a board a camera's calibration needs next, until they are enough",
          "alidade guide session.mp4 --board chessboard:9x6:25mm -o capture", OutputUse::Required,
          make_command<GuideCommand>};
}

}  // namespace alidade
