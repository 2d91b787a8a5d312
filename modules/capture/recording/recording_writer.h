// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/capture_event.h"
#include "capture/recording/session_file.h"
#include "io/append_file.h"

namespace alidade {

/// What is recorded, for session.json.
struct RecordingSubject {
  std::string program;  ///< name and version of what records
  CameraFacts camera;
  CameraRequest request{};
};

/// Records one camera into a folder: session.json, frames.csv, events.csv, video.mkv; the last three are called
/// NAME.part until close(). Every frame is kept as it came, bit by bit, damaged ones too.
///
/// A frame's row in frames.csv confirms it: the row is handed to the kernel in one piece after the frame was. So when
/// the program dies, at any moment, every row is whole but perhaps the last, its frame can be read by any program
/// without a repair, and at most the one frame that was being written has no row. A power cut costs what the kernel had
/// not written yet: it is asked to every RecorderOptions::writeback_s, but never waited for, since a disk may take
/// seconds over it while the camera goes on.
/// One thread uses it.
class RecordingWriter {
 public:
  /// Creates the folder where there is none. Throws InputError where it holds files of a recording, DeviceError where
  /// it cannot be written or the camera's images cannot be recorded, std::invalid_argument by validate(options).
  RecordingWriter(std::filesystem::path folder, RecordingSubject subject, const RecorderOptions& options = {});
  /// Without close(): the .part files stay as they are.
  ~RecordingWriter();
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;

  /// Returns once the frame is confirmed. Throws DiskFull where the disk, or the room that the options leave, has no
  /// place for it: "disk full; 37 frames are safe in DIR". The recording is then closed as far as the disk allows, and
  /// nothing more can be written. DeviceError where the file system refuses for another reason, or the frame is not of
  /// the camera's size or format.
  void write(const Frame& frame);

  /// Writes an event. Throws as write() does.
  void note(const CaptureEvent& event);

  /// Gives all files their names, and session.json the totals and checksums. Nothing where it is closed already.
  void close(const std::vector<std::pair<std::string, std::uint64_t>>& statistics = {});

  bool is_open() const;                     ///< whether more can be written
  const RecordingSession& session() const;  ///< as it stands
  std::int64_t bytes() const;               ///< written so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alidade
