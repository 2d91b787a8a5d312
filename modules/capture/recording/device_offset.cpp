// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/device_offset.h"

namespace alidade {

void DeviceOffset::observe(Timestamp time, const CaptureStamp& stamp, const CameraFacts& camera) {
  constexpr int kStart = 64;  // frames
  if (!stamp.device_time) return;
  at_end_ = time - stamp_to_middle(camera) - *stamp.device_time;
  if (seen_++ < kStart) at_start_ = at_end_;
}

}  // namespace alidade
