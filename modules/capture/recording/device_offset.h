// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

#include "capture/clock_offset.h"
#include "capture/frame_source.h"

namespace alidade {

/// Host time minus device time at the start and at the end of a recording, for its record.
class DeviceOffset {
 public:
  void observe(const CaptureStamp& stamp);

  /// After the first 64 frames that tell both times, or as many as came; empty before the first.
  std::optional<std::chrono::nanoseconds> at_start() const { return at_start_; }
  std::optional<std::chrono::nanoseconds> at_end() const { return clock_.offset(); }

 private:
  ClockOffset clock_;
  std::optional<std::chrono::nanoseconds> at_start_;
  int seen_ = 0;
};

}  // namespace alidade
