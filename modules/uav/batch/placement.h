// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "camera/receiver.h"
#include "uav/batch/motion_fit.h"

namespace alidade {

/// What receivers are asked to locate: a target that flies through a volume, and when they look at it.
struct PlacementOptions {
  Eigen::Vector3d least_world = Eigen::Vector3d(-100, -100, 10);  ///< m; corners of the volume
  Eigen::Vector3d greatest_world = Eigen::Vector3d(100, 100, 90);
  double step_m = 10.0;  ///< between the points of the grid, along each axis
  int periods = 5;       ///< that a position is from: the batch's window
  double period_s = 1.0;
  std::vector<double> delays_s{0.0};  ///< of each receiver's look after a period's begin; repeated where there are more
  Eigen::Vector3d v_world = Eigen::Vector3d(15, 0, 0);  ///< m/s
  MotionModel model = MotionModel::Velocity;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const PlacementOptions& options);

/// How well a target is located at a place.
struct PlacementPoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  int receivers = 0;            ///< that see the target at least once
  std::optional<double> rms_m;  ///< the least RMS of a position (Cramér–Rao); empty where it is not determined
};

/// Points of a grid, x running fastest, then y, then z.
struct PlacementMap {
  std::array<int, 3> counts{};  ///< along x, y, z
  std::vector<PlacementPoint> points;
};

/// The exact bearings of a target that is at `p_world` at the time of the last look, as the receivers would report them
/// on the way there: only those in whose view it is, with the covariance of their own noise.
std::vector<Bearing> planned_bearings(std::span<const Receiver> receivers, const PlacementOptions& options,
                                      const Eigen::Vector3d& p_world);

/// The bound of the position's RMS at the time of the last look. Errors of the receivers' own poses and clocks are not
/// in it. Throws as validate.
/// Source: UAV paper eqs. 12 and 13, for any receivers and times; the paper page, "Where we go past it", 6.
PlacementPoint bound_at(std::span<const Receiver> receivers, const PlacementOptions& options,
                        const Eigen::Vector3d& p_world);
PlacementMap map_placement(std::span<const Receiver> receivers, const PlacementOptions& options);

}  // namespace alidade
