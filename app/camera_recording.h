// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "app/camera_options.h"
#include "capture/capture_event.h"
#include "capture/recording/recorder_options.h"
#include "capture/recording/recording_writer.h"

namespace alidade {

/// A camera and the folder of its recording.
struct NamedCamera {
  std::string name;  ///< of the folder; empty for the only camera
  std::string source;
};

/// The cameras that "NAME=SOURCE" or "SOURCE" say; several without a name are camera_0, camera_1, … Throws InputError
/// for names that are alike or no folder's.
std::vector<NamedCamera> parse_named_cameras(const std::vector<std::string>& words);

/// How much is recorded; empty: until it is stopped.
struct RecordingLimits {
  std::optional<int> frames;
  std::optional<double> duration_s;
};

/// How far a recording is.
struct RecordingProgress {
  std::int64_t frames = 0;
  std::int64_t bytes = 0;
  std::uint64_t dropped = 0;    ///< counted by the camera, never came
  std::uint64_t discarded = 0;  ///< given up by our queue
  std::int64_t damaged = 0;
};

/// One camera being recorded: a thread that captures, a queue of some seconds between, and a thread that writes.
class CameraRecording {
 public:
  /// Opens the camera. `news`: told of every event, from several threads. Throws CameraError, InputError.
  CameraRecording(NamedCamera camera, const CameraOptions& options, CaptureEventSink news);
  ~CameraRecording();

  const NamedCamera& camera() const { return camera_; }

  /// Begins to write; `on_failure` is called where that fails. Throws as RecordingWriter does.
  void start(const std::filesystem::path& folder, const RecorderOptions& options, const RecordingLimits& limits,
             std::function<void()> on_failure);

  RecordingProgress progress() const;
  bool has_ended() const { return ended_; }  ///< at its limit, or by a failure

  /// Writes what has come so far, and closes. Throws what went wrong while it was written.
  void finish();

 private:
  class CountedDevice;

  std::unique_ptr<CameraDevice> open_as_before(const CameraOpener& open);
  void take(const CaptureEvent& event);
  void write_frames(std::stop_token stop, RecordingLimits limits);
  void write_events(std::stop_token* rearmed);
  bool is_full(const Frame& frame, const RecordingLimits& limits) const;
  void write(const Frame& frame);

  NamedCamera camera_;
  CameraRequest request_;
  CaptureEventSink news_;
  std::optional<CameraFacts> facts_;
  std::map<std::string, std::uint64_t> statistics_;  // the capture thread's while it runs
  std::optional<RecordingWriter> writer_;

  mutable std::mutex mutex_;
  std::vector<CaptureEvent> events_;  // not yet written
  std::stop_source wake_;             // the writing thread, for events
  RecordingProgress progress_;

  HostTime begin_{};
  std::atomic<bool> ended_ = false;
  std::exception_ptr error_;
  std::unique_ptr<FrameSource> frames_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace alidade
