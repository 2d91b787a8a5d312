// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/device_offset.h"

#include <algorithm>

namespace alidade {
namespace {

constexpr int kFrames = 64;

}  // namespace

void DeviceOffset::observe(const CaptureStamp& stamp) {
  if (!stamp.device_time || !stamp.host_time) return;
  const std::chrono::nanoseconds offset = stamp.host_time->time_since_epoch() - stamp.device_time->time_since_epoch();
  if (seen_++ < kFrames) at_start_ = at_start_ ? std::min(*at_start_, offset) : offset;
  last_.push_back(offset);
  if (last_.size() > kFrames) last_.pop_front();
}

std::optional<std::chrono::nanoseconds> DeviceOffset::at_end() const {
  if (last_.empty()) return std::nullopt;
  return *std::min_element(last_.begin(), last_.end());
}

}  // namespace alidade
