// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "capture/recording/recording_writer.h"

namespace alidade::test {

/// What a killed recording left.
struct KilledRecording {
  int captured = 0;               ///< frames that the writer was given, the last perhaps not to its end
  int confirmed = 0;              ///< whole rows in frames.csv.part
  int read_by_us = 0;             ///< frames that open_recording gives
  int wrong = 0;                  ///< of these, not exactly as given
  std::optional<int> by_ffprobe;  ///< frames that ffprobe decodes; empty where it is not installed
};

/// Records a synthetic camera into `folder` in a process of its own, as fast as it goes, and kills it (SIGKILL) after
/// `delay`.
KilledRecording record_and_kill(const std::filesystem::path& folder, const RecordingSubject& camera,
                                const RecorderOptions& options, std::chrono::microseconds delay);

/// Frames that ffprobe decodes of a video; empty where it is not installed.
std::optional<int> count_by_ffprobe(const std::filesystem::path& video);

}  // namespace alidade::test
