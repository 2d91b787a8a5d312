// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include "capture/frame_source.h"

namespace alidade {

/// The host's time at a device's, from pairs of both. A frame is seen later than it was stamped, never earlier, and
/// mostly hardly later; so the line that lies below all pairs (device time, difference) and nearest to them is how the
/// clocks differ, rate included.
/// Source: Moon, Skelly, Towsley, "Estimation and removal of clock skew from network delay measurements", 1999.
class ClockOffset {
 public:
  /// One frame: stamped `device`, seen at `host`. True where the device's clock has been set anew (it goes backwards,
  /// or ahead by more than half a second): all before is forgotten.
  bool observe(Timestamp device, HostTime host);

  /// `device` on the host's clock, from the pairs of the last 30 s; empty before the first.
  std::optional<HostTime> to_host(Timestamp device) const;

  /// Host time minus device time at the last pair; empty before the first.
  std::optional<std::chrono::nanoseconds> offset() const;

 private:
  struct Pair {
    double device_s = 0;      // since first_device_
    double difference_s = 0;  // host minus device, since first_difference_
  };

  void fit();
  double difference_at(double device_s) const { return intercept_s_ + slope_ * device_s; }

  std::optional<Timestamp> first_device_;
  std::chrono::nanoseconds first_difference_{};
  Timestamp last_device_{};
  std::deque<Pair> pairs_;  // the least difference of each quarter of a second, by device time
  double intercept_s_ = 0, slope_ = 0;
};

}  // namespace alidade
