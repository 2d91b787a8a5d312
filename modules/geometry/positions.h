// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "core/time.h"

namespace alidade {

/// Where a point was at one moment, in a frame of its owner's.
struct TimedPosition {
  Timestamp time{};
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< m
};

/// The position at `time`, on the straight line between its neighbours; empty outside the positions, which are in order
/// of time, and between two that are more than `longest_gap` apart.
std::optional<Eigen::Vector3d> position_at(std::span<const TimedPosition> positions, Timestamp time,
                                           RecordingClock::duration longest_gap);

}  // namespace alidade
