// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/device_offset.h"

namespace alidade {

void DeviceOffset::observe(const CaptureStamp& stamp) {
  constexpr int kStart = 64;  // frames
  if (!stamp.device_time || !stamp.host_time) return;
  clock_.observe(*stamp.device_time, *stamp.host_time);
  if (seen_++ < kStart) at_start_ = clock_.offset();
}

}  // namespace alidade
