// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "capture/frame_source.h"

namespace alidade::test {

/// The clock of a camera: what it showed when the host's clock showed 0, and how much it runs fast.
struct DeviceClock {
  std::chrono::nanoseconds offset{};
  double rate_error_ppm = 0;

  /// Ticks of 1 ns at the host's time.
  std::uint64_t ticks(HostTime host) const {
    const std::chrono::nanoseconds elapsed = host.time_since_epoch();
    const auto gained = static_cast<std::int64_t>(static_cast<double>(elapsed.count()) * rate_error_ppm * 1e-6);
    return static_cast<std::uint64_t>((offset + elapsed).count() + gained);
  }
};

}  // namespace alidade::test
