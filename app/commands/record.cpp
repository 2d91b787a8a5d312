// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/camera_recording.h"
#include "app/capture_warnings.h"
#include "app/commands/verbs.h"
#include "app/record_report.h"
#include "app/version.h"
#include "capture/recording/recording_group.h"
#include "io/atomic_file.h"

namespace alidade {
namespace {

constexpr double kMega = 1e6;

class RecordCommand : public Command {
 public:
  explicit RecordCommand(CLI::App& flags) {
    flags.add_option("SOURCE", words_, "cameras: v4l2:/dev/video0, genicam:192.168.0.7, left=genicam:SERIAL")
        ->required();
    flags.add_option("--frames", limits_.frames, "of each camera; else until Ctrl-C")->check(CLI::PositiveNumber);
    flags.add_option("--duration", limits_.duration_s, "s; else until Ctrl-C")->check(CLI::PositiveNumber);
    options_.add_choice("codec", codec_,
                        {{"auto", -1},
                         {"raw", static_cast<int>(LosslessCodec::Raw)},
                         {"ffvhuff", static_cast<int>(LosslessCodec::FfvHuff)},
                         {"ffv1", static_cast<int>(LosslessCodec::Ffv1)}},
                        "all lossless; auto: the smallest file whose packing keeps up with the camera");
    options_.add("keep_free_mb", keep_free_mb_, "MB", "of the disk that stay free: there the recording ends");
    options_.add("most_mb", most_mb_, "MB", "of each camera's recording; 0: no bound");
    bind(options_, flags, camera_);
    options_.add_check([this] {
      if (!(keep_free_mb_ >= 0))
        throw std::invalid_argument(fmt::format("keep_free_mb must be >= 0, got {}", keep_free_mb_));
      if (!(most_mb_ >= 0)) throw std::invalid_argument(fmt::format("most_mb must be >= 0, got {}", most_mb_));
    });
  }

  ExitCode run(const RunContext& context) override {
    std::vector<std::unique_ptr<CameraRecording>> cameras;
    for (NamedCamera& camera : parse_named_cameras(words_)) {
      cameras.push_back(std::make_unique<CameraRecording>(std::move(camera), camera_, warn_of_news(context)));
    }
    start(context, cameras);
    const bool is_interrupted = watch(context, cameras);
    finish(cameras);
    if (cameras.size() > 1) write_group(context, cameras);
    report(context, is_interrupted);
    return is_interrupted ? ExitCode::Interrupted : ExitCode::Success;
  }

 private:
  using Cameras = std::vector<std::unique_ptr<CameraRecording>>;

  void start(const RunContext& context, Cameras& cameras) {
    RecorderOptions options;
    if (codec_ >= 0) options.codec = static_cast<LosslessCodec>(codec_);
    options.keep_free_bytes = static_cast<std::int64_t>(keep_free_mb_ * kMega);
    if (most_mb_ > 0) options.max_bytes = static_cast<std::int64_t>(most_mb_ * kMega);
    options.busy_share /= static_cast<double>(cameras.size());
    for (const auto& camera : cameras) {
      const std::string& name = camera->camera().name;
      camera->start(name.empty() ? context.output : context.output / name, options, limits_, [this] {
        const std::scoped_lock lock(mutex_);
        has_failed_ = true;
        changed_.notify_all();
      });
    }
    if (cameras.size() > 1) write_group(context, cameras);
  }

  // Until all are done, one fails, the time is over, or the user stops it (true).
  bool watch(const RunContext& context, const Cameras& cameras) {
    const HostTime begin = HostClock::now();
    const auto has_ended = [](const auto& camera) { return camera->has_ended(); };
    while (!std::all_of(cameras.begin(), cameras.end(), has_ended)) {
      {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, context.stop, std::chrono::milliseconds(100), [this] { return has_failed_; });
        if (has_failed_) return false;
      }
      if (context.stop.stop_requested()) return true;
      const double passed_s = to_seconds(HostClock::now() - begin);
      tell_progress(context, cameras, passed_s);
      if (limits_.duration_s && passed_s >= *limits_.duration_s + 0.5) return false;
    }
    return false;
  }

  void tell_progress(const RunContext& context, const Cameras& cameras, double passed_s) {
    std::int64_t frames = 0;
    std::uint64_t lost = 0;
    for (const auto& camera : cameras) {
      const RecordingProgress progress = camera->progress();
      frames += progress.frames;
      lost += progress.dropped + progress.discarded + static_cast<std::uint64_t>(progress.damaged);
    }
    Progress progress{"recording", frames, 0, ""};
    if (limits_.frames) progress.total = *limits_.frames * static_cast<std::int64_t>(cameras.size());
    if (limits_.duration_s) {
      progress.done = static_cast<std::int64_t>(passed_s);
      progress.total = static_cast<std::int64_t>(std::ceil(*limits_.duration_s));
    }
    if (lost > told_lost_) progress.message = fmt::format("{} frames lost or damaged", lost);
    told_lost_ = lost;
    context.progress(progress);
  }

  // All are closed before the first failure is told.
  static void finish(Cameras& cameras) {
    std::exception_ptr error;
    for (const auto& camera : cameras) {
      try {
        camera->finish();
      } catch (...) {
        if (!error) error = std::current_exception();
      }
    }
    if (error) std::rethrow_exception(error);
  }

  static void write_group(const RunContext& context, const Cameras& cameras) {
    std::vector<std::string> members;
    for (const auto& camera : cameras) members.push_back(camera->camera().name);
    write_recording_group(context.output, std::string("alidade ") + kVersion, members);
  }

  void report(const RunContext& context, bool is_interrupted) const {
    const RecordRecord record{read_recorded(context.output), {}, is_interrupted};
    write_file(context.output / "options.yaml", options_.to_yaml());
    write_report(context.output / "report.html", report_of(record, context.arguments, options_.to_yaml()));
    const nlohmann::json summary = summary_of(record);
    write_file(context.output / "summary.json", summary.dump(2) + "\n");
    for (const std::string& line : table_lines(record)) context.tell(line);
    context.tell(fmt::format("written to {}", context.output.string()));
    context.publish(summary);
  }

  std::vector<std::string> words_;
  RecordingLimits limits_;
  int codec_ = -1;
  double keep_free_mb_ = 256, most_mb_ = 0;
  CameraOptions camera_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  bool has_failed_ = false;
  std::uint64_t told_lost_ = 0;
};

}  // namespace

Verb record_verb() {
  return {"record", "what cameras see, losslessly, and every frame that they lost",
          "alidade record v4l2:/dev/video0 -o session --duration 60\n"
          "alidade record left=genicam:192.168.0.7 right=genicam:192.168.0.8 -o pair",
          OutputUse::Required, make_command<RecordCommand>};
}

}  // namespace alidade
