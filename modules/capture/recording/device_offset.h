// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

#include "capture/camera_device.h"
#include "capture/frame_source.h"

namespace alidade {

/// Host time minus device time at the start and at the end of a recording, for its record: as Frame::time, which
/// LiveCamera put on the host's clock, has it.
class DeviceOffset {
 public:
  /// A frame's Frame::time and stamp.
  void observe(Timestamp time, const CaptureStamp& stamp, const CameraFacts& camera);

  /// After the first 64 frames that tell both times, or as many as came; empty before the first.
  std::optional<std::chrono::nanoseconds> at_start() const { return at_start_; }
  std::optional<std::chrono::nanoseconds> at_end() const { return at_end_; }

 private:
  std::optional<std::chrono::nanoseconds> at_start_, at_end_;
  int seen_ = 0;
};

}  // namespace alidade
