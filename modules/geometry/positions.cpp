// SPDX-License-Identifier: Apache-2.0
#include "geometry/positions.h"

#include <algorithm>

namespace alidade {

std::optional<Eigen::Vector3d> position_at(std::span<const TimedPosition> positions, Timestamp time,
                                           RecordingClock::duration longest_gap) {
  const auto after = std::lower_bound(positions.begin(), positions.end(), time,
                                      [](const TimedPosition& p, Timestamp t) { return p.time < t; });
  if (after == positions.end()) return std::nullopt;
  if (after->time == time) return after->p;
  if (after == positions.begin()) return std::nullopt;
  const TimedPosition& before = *(after - 1);
  if (after->time - before.time > longest_gap) return std::nullopt;
  const double fraction = to_seconds(time - before.time) / to_seconds(after->time - before.time);
  return before.p + fraction * (after->p - before.p);
}

}  // namespace alidade
