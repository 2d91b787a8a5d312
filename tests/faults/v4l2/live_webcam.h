// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "capture/capture_event.h"
#include "capture/frame_source.h"

namespace alidade::test {

/// The machine's webcam as the program captures from it, with all that is told of it.
class LiveWebcam {
 public:
  explicit LiveWebcam(double fps_hz = 30);

  /// The next frame; a test failure and empty where none comes for 10 s.
  std::optional<Frame> next();

  /// Reads `count` frames; false where they do not come.
  bool read(int count);

  /// Reads until a frame comes after an event of that kind which happened after `since`; the event.
  std::optional<CaptureEvent> read_past(CaptureEventKind kind, HostTime since);

  /// The first event of that kind since then.
  std::optional<CaptureEvent> find(CaptureEventKind kind, HostTime since) const;
  int count(CaptureEventKind kind) const;

  HostTime last_frame_time() const { return last_frame_time_; }

 private:
  std::vector<CaptureEvent> events_;
  std::unique_ptr<FrameSource> source_;
  HostTime last_frame_time_{};
};

}  // namespace alidade::test
