// SPDX-License-Identifier: Apache-2.0
#include "camera/static_triangulation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {

void validate(const StaticTriangulationOptions& options) {
  if (!(options.within_s > 0.0)) {
    throw std::invalid_argument(fmt::format("within_s must be > 0, got {}", options.within_s));
  }
  if (options.least_receivers < 2) {
    throw std::invalid_argument(fmt::format("least_receivers must be >= 2, got {}", options.least_receivers));
  }
  if (!(options.least_angle_rad > 0.0)) {
    throw std::invalid_argument(fmt::format("least_angle_rad must be > 0, got {}", options.least_angle_rad));
  }
}

std::vector<Bearing> nearest_bearings(std::span<const Bearing> bearings, Timestamp time,
                                      RecordingClock::duration within) {
  const auto by_time = [](const Bearing& b, Timestamp t) { return b.time < t; };
  std::vector<Bearing> nearest;
  for (auto it = std::lower_bound(bearings.begin(), bearings.end(), time - within, by_time);
       it != bearings.end() && it->time <= time + within; ++it) {
    const auto same = std::find_if(nearest.begin(), nearest.end(),
                                   [&](const Bearing& other) { return other.receiver == it->receiver; });
    if (same == nearest.end()) {
      nearest.push_back(*it);
    } else if (std::chrono::abs(it->time - time) < std::chrono::abs(same->time - time)) {
      *same = *it;
    }
  }
  std::stable_sort(nearest.begin(), nearest.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return nearest;
}

std::optional<Intersection> triangulate_static(std::span<const Bearing> bearings, Timestamp time,
                                               const StaticTriangulationOptions& options) {
  validate(options);
  std::vector<Ray> rays;
  for (const Bearing& b : nearest_bearings(bearings, time, from_seconds(options.within_s))) {
    rays.push_back({b.origin_world, b.direction_world, std::sqrt(0.5 * b.covariance.trace())});
  }
  if (static_cast<int>(rays.size()) < options.least_receivers) return std::nullopt;
  return intersect_rays(rays, options.least_angle_rad);
}

}  // namespace alidade
