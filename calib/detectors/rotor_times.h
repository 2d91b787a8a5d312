// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/line_detector.h"
#include "camera/measurement.h"

namespace alidade {

/// Readings at the times at which their sweeps passed, as the rotors have it.
struct RotorTimes {
  std::vector<LineReading> readings;  ///< in order of time; without those of a rotation of which a sweep is missing
  double clock_ratio = 1.0;           ///< seconds of the recording's clock in a second of the rotors
  double delay_range_s = 0.0;         ///< how much longer than others some rotations waited to be stamped
};

/// Second-generation laser sweeps turn at one of sixteen known periods, so that a raw angle says when the laser passed,
/// but for the rotor's phase. Receivers that hand out a rotation only once the next sweep, whosever, has ended it stamp
/// it late, by zero to ten and more milliseconds that drift with the beat of the stations. This finds the clock's rate
/// and each rotor's phase (the least delayed rotations count as not delayed) from the recording alone and gives every
/// reading its own time; the times as a whole stay where they were (median). Empty where there is nothing to repair or
/// too little to go by: fewer than two stations of such sweeps, under 200 rotations of one or 20 s, stamps that agree
/// with the rotors within 1 ms or with none of their periods, stations whose delays span differently. Readings in order
/// of time, by one clock; those of other detectors keep their times.
std::optional<RotorTimes> time_by_rotors(std::span<const LineDetector> detectors,
                                         std::span<const LineReading> readings);

}  // namespace alidade
