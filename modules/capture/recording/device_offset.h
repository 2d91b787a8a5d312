// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include "capture/frame_source.h"

namespace alidade {

/// Host time minus device time over the first and over the last frames of a recording, for its record.
class DeviceOffset {
 public:
  void observe(const CaptureStamp& stamp);

  std::optional<std::chrono::nanoseconds> at_start() const { return at_start_; }
  std::optional<std::chrono::nanoseconds> at_end() const;

 private:
  std::optional<std::chrono::nanoseconds> at_start_;
  int seen_ = 0;
  std::deque<std::chrono::nanoseconds> last_;
};

}  // namespace alidade
