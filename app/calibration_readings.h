// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/run_context.h"
#include "camera/detector_rig.h"
#include "camera/measurement.h"
#include "geometry/positions.h"
#include "geometry/rigid_body.h"

namespace alidade {

/// A part of a recording, by its own clock.
struct TimeInterval {
  std::optional<double> start_s;  ///< empty: from the beginning
  std::optional<double> end_s;    ///< not itself; empty: to the end
};

/// Whether some moment is in both.
bool overlap(const TimeInterval& a, const TimeInterval& b);

/// What the user called a recording and the flags of its interval, for messages.
struct IntervalNames {
  std::string source, start_flag, end_flag;
};

/// All readings of a recording (see open_readings), with progress; what was read before a stop. Throws InputError as
/// the source does and where there is no reading.
std::vector<LineReading> read_all(const std::string& path, const DetectorRig& rig, const std::vector<RigidBody>& bodies,
                                  const RunContext& context);

/// The same with the times that the rotors of laser sweeps give them, where that repairs anything (see time_by_rotors);
/// what it did is added to `warnings`.
std::vector<LineReading> repair_times(std::vector<LineReading> readings, const DetectorRig& rig,
                                      const std::string& source, std::vector<std::string>& warnings);

/// The readings within an interval. Throws InputError where there is none, telling what the recording spans.
std::vector<LineReading> take_interval(const std::vector<LineReading>& readings, const TimeInterval& interval,
                                       const IntervalNames& names);

/// The body of this name, or, without a name, the only one. Throws InputError naming those there are.
RigidBody choose_body(const std::vector<RigidBody>& bodies, const std::string& name, const std::string& path);

/// Throws InputError naming the nearest station where none is called so; an empty name is none.
void require_station(const DetectorRig& rig, const std::string& name, const std::string& path);

/// Throws InputError where no position lies within the time of the readings, telling what both span.
void require_overlap(std::span<const TimedPosition> positions, const std::vector<LineReading>& readings,
                     const std::string& path);

}  // namespace alidade
