// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "capture/frame_source.h"

namespace alidade {

/// The host's time at a device's, from pairs of both: a stamp is seen later than it was made, never earlier, so the
/// smallest difference of the last while is the offset, and how it moves the rate between the clocks.
class ClockOffset {
 public:
  /// One frame: stamped `device`, seen at `host`. The device's times must increase; if they do not it has restarted,
  /// and all before is forgotten (true is returned).
  bool observe(Timestamp device, HostTime host);

  /// `device` on the host's clock; empty before the first observation.
  std::optional<HostTime> to_host(Timestamp device) const;

  /// Host time minus device time, now; empty before the first observation.
  std::optional<std::chrono::nanoseconds> offset() const;
};

}  // namespace alidade
