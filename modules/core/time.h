// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace alidade {

/// The clock of a recording: whatever its timestamps count from. Not readable, only carried.
struct RecordingClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<RecordingClock>;
  static constexpr bool is_steady = true;
};

/// A moment in a recording, in integer nanoseconds.
using Timestamp = RecordingClock::time_point;

/// Seconds between two moments, or of a duration.
double to_seconds(RecordingClock::duration duration);

/// The duration nearest to `seconds`, in nanoseconds.
RecordingClock::duration from_seconds(double seconds);

/// Parses decimal seconds ("1305031229.528748", "1e3") into nanoseconds without passing plain decimals through a
/// double, so that no digit is lost. Empty where the text is not a finite number that fits.
std::optional<Timestamp> parse_seconds(std::string_view text);

/// Decimal seconds with nine digits behind the point; parse_seconds gives back the same moment.
std::string format_seconds(Timestamp time);

}  // namespace alidade
