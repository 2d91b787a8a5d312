// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera_device.h"
#include "capture/recording/frame_row.h"
#include "capture/recording/recorder_options.h"

namespace alidade {

/// One moment on both of the host's clocks.
struct ClockReading {
  HostTime host{};
  std::chrono::nanoseconds utc{};  ///< since 1970
};
ClockReading read_clocks();

/// A file of a closed recording.
struct RecordedFile {
  std::string name;
  std::int64_t bytes = 0;
  std::uint32_t crc32 = 0;
};

/// What session.json says of a recording.
struct RecordingSession {
  std::string program;     ///< name and version of what recorded it
  bool is_closed = false;  ///< false while it is recorded, and after an interruption until it is repaired
  bool is_repaired = false;
  CameraFacts camera;
  CameraRequest request;
  RecorderOptions options;
  std::optional<LosslessCodec> codec;    ///< chosen when the recording begins
  std::optional<Timestamp> video_start;  ///< Frame::time of the first frame in the video, whose own time there is 0
  ClockReading start;
  std::optional<ClockReading> end;
  /// Host time minus device time (ClockOffset) at the start and the end; empty where the camera stamps nothing.
  std::optional<std::chrono::nanoseconds> offset_at_start, offset_at_end;
  RecordingTotals totals;  ///< of a closed recording
  std::int64_t events = 0;
  std::vector<std::pair<std::string, std::uint64_t>> statistics;  ///< CameraDevice::statistics at the end
  std::vector<RecordedFile> files;                                ///< of a closed recording

  LosslessFormat format() const;  ///< of the video
};

/// How the frames of a camera lie in a video.
PixelLayout layout_of(const PixelFormat& format);

/// Throws DeviceError where it cannot be written; it is there whole or not at all.
void write_session(const std::filesystem::path& folder, const RecordingSession& session);

/// Throws InputError where session.json is missing, damaged, no recording's, or of a later version of the format.
RecordingSession read_session(const std::filesystem::path& folder);

}  // namespace alidade
