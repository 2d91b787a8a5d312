// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/measurement.h"
#include "geometry/triangulation.h"

namespace alidade {

struct StaticTriangulationOptions {
  double within_s = 0.1;  ///< a bearing farther from the moment is left out: at 10 m/s the target is 1 m on
  int least_receivers = 2;
  double least_angle_rad = 0.03;  ///< below it the point's range is next to unknown
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const StaticTriangulationOptions& options);

/// Of each receiver the bearing nearest to `time`, at most `within` away, in order of time. `bearings` are in order of
/// time; of equally near ones the earlier.
std::vector<Bearing> nearest_bearings(std::span<const Bearing> bearings, Timestamp time,
                                      RecordingClock::duration within);

/// Where the nearest bearings of one target meet, taken as if it stood still: the usual form, which leaves out when
/// each receiver looked. Empty where they are too few or do not meet (see intersect_rays). Source: UAV paper eq. 6.
std::optional<Intersection> triangulate_static(std::span<const Bearing> bearings, Timestamp time,
                                               const StaticTriangulationOptions& options = {});

}  // namespace alidade
