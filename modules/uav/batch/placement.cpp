// SPDX-License-Identifier: Apache-2.0
#include "uav/batch/placement.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "uav/batch/motion_bound.h"

namespace alidade {
namespace {

constexpr double kMostPoints = 1e7;  // a gigabyte

void require(bool is_so, const char* field, const char* bound, double value) {
  if (!is_so) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

std::array<int, 3> counts_of(const PlacementOptions& options) {
  std::array<int, 3> counts{};
  for (int i = 0; i < 3; ++i) {
    const double length = options.greatest_world[i] - options.least_world[i];
    counts[static_cast<std::size_t>(i)] = 1 + static_cast<int>(std::floor(length / options.step_m + 1e-9));
  }
  return counts;
}

double delay_of(const PlacementOptions& options, std::size_t receiver) {
  return options.delays_s[receiver % options.delays_s.size()];
}

Timestamp last_look(std::span<const Receiver> receivers, const PlacementOptions& options) {
  double latest = 0.0;
  for (std::size_t k = 0; k < receivers.size(); ++k) latest = std::max(latest, delay_of(options, k));
  return Timestamp(from_seconds((options.periods - 1) * options.period_s + latest));
}

TargetState target_at(std::span<const Receiver> receivers, const PlacementOptions& options,
                      const Eigen::Vector3d& p_world) {
  TargetState target;
  target.time = last_look(receivers, options);
  target.p_world = p_world;
  target.v_world = options.v_world;
  return target;
}

}  // namespace

void validate(const PlacementOptions& o) {
  for (int i = 0; i < 3; ++i) {
    require(std::isfinite(o.least_world[i]), "least_world", "finite", o.least_world[i]);
    require(o.greatest_world[i] >= o.least_world[i] && std::isfinite(o.greatest_world[i]), "greatest_world",
            ">= least_world in each coordinate", o.greatest_world[i]);
  }
  require(o.step_m > 0.0, "step_m", "> 0 m", o.step_m);
  const double points = (((o.greatest_world - o.least_world) / o.step_m).array().floor() + 1.0).prod();
  require(points <= kMostPoints, "step_m", "so large that the grid has at most 1e7 points", o.step_m);
  require(o.periods >= 1, "periods", ">= 1", o.periods);
  require(o.period_s > 0.0, "period_s", "> 0 s", o.period_s);
  require(!o.delays_s.empty(), "delays_s", "at least one delay", 0.0);
  for (const double delay : o.delays_s) require(delay >= 0.0 && std::isfinite(delay), "delays_s", ">= 0 s", delay);
  require(o.v_world.allFinite(), "v_world", "finite", o.v_world.norm());
}

std::vector<Bearing> planned_bearings(std::span<const Receiver> receivers, const PlacementOptions& options,
                                      const Eigen::Vector3d& p_world) {
  const TargetState target = target_at(receivers, options, p_world);
  std::vector<Bearing> bearings;
  for (int period = 0; period < options.periods; ++period) {
    for (std::size_t k = 0; k < receivers.size(); ++k) {
      const Timestamp time(from_seconds(period * options.period_s + delay_of(options, k)));
      const auto reading = reading_of(receivers[k], moved_to(target, time).p_world, time);
      if (!reading) continue;
      auto bearing = bearing_of(receivers[k], *reading);
      if (bearing) bearings.push_back(*bearing);
    }
  }
  return bearings;
}

PlacementPoint bound_at(std::span<const Receiver> receivers, const PlacementOptions& options,
                        const Eigen::Vector3d& p_world) {
  validate(options);
  PlacementPoint point;
  point.p_world = p_world;
  const std::vector<Bearing> bearings = planned_bearings(receivers, options, p_world);
  std::set<int> seeing;
  for (const Bearing& bearing : bearings) seeing.insert(bearing.receiver);
  point.receivers = static_cast<int>(seeing.size());
  if (bearings.empty()) return point;
  const auto bound = motion_bound(target_at(receivers, options, p_world), bearings, options.model);
  if (bound) point.rms_m = std::sqrt(bound->topLeftCorner<3, 3>().trace());
  return point;
}

PlacementMap map_placement(std::span<const Receiver> receivers, const PlacementOptions& options) {
  validate(options);
  PlacementMap map;
  map.counts = counts_of(options);
  for (int z = 0; z < map.counts[2]; ++z) {
    for (int y = 0; y < map.counts[1]; ++y) {
      for (int x = 0; x < map.counts[0]; ++x) {
        const Eigen::Vector3d p_world = options.least_world + options.step_m * Eigen::Vector3d(x, y, z);
        map.points.push_back(bound_at(receivers, options, p_world));
      }
    }
  }
  return map;
}

}  // namespace alidade
