// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/recording/frame_row.h"
#include "core/progress.h"

namespace alidade {

/// Something in a recording that is not as it was recorded.
struct RecordingFault {
  std::filesystem::path path;
  int line = 0;  ///< from 1; 0: the file as a whole
  std::string what;
};

struct RecordingVerification {
  RecordingTotals totals;  ///< of the rows read
  std::int64_t bytes = 0;  ///< of all files
  bool is_closed = false;
  std::vector<RecordingFault> faults;  ///< in the order of the files; an unclosed recording is one
};

/// Reads a whole recording again: the checksum of every file, of the pixels of every frame; that each row has its frame
/// and each frame its row; that counts and lost frames are those that session.json states, times increase, and gaps in
/// the camera's own count are the frames that are said to be lost (but where it began to count anew, by events.csv).
/// What the camera lost or damaged is no fault of the recording. Nothing is changed.
/// Throws InputError where it is no recording.
RecordingVerification verify_recording(const std::filesystem::path& folder, const ProgressSink& progress = {});

}  // namespace alidade
