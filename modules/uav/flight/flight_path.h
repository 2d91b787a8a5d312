// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/measurement.h"
#include "camera/receiver.h"
#include "uav/target_state.h"

namespace alidade {

struct FlightPathOptions {
  double step_s = 0.2;               ///< between the states; within half of it the motion is a parabola
  double acceleration_m_s2 = 4.0;    ///< standard deviation of each coordinate: a multicopter that is flown briskly
  double acceleration_time_s = 1.0;  ///< how long it goes on accelerating as it does
  double speed_m_s = 10.0;           ///< of each coordinate, at the begin
  double turn_rad = 1e-3;            ///< how far directions of a receiver without a pose covariance may be off
  double range_m = 60.0;             ///< at which errors of receivers' places count as turns
  double drift_time_s = 10.0;        ///< how long a receiver's directions go on being off as they are: they depend on
                                     ///< where in the picture the target is, by the lens and the pose
  double clock_history_s = 300.0;    ///< the time in which the stated uncertainty of a clock's rate came about: its
                                     ///< offset walks on at that pace
  double correlation_s = 0.5;        ///< readings of a receiver within it err alike and count as one
  double loss_sigmas = 3.0;          ///< beyond it a reading counts less (Cauchy)
  double seen_s = 0.5;               ///< a receiver counts as seeing the target this long before and after it does
  int most_passes = 10;              ///< four are usual
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const FlightPathOptions& options);

/// What a receiver was found to be off by at one moment.
struct ReceiverError {
  Eigen::Vector2d turn_rad = Eigen::Vector2d::Zero();  ///< about its own x and y axes
  double clock_s = 0.0;                                ///< to be added to the times of its bearings
  double clock_sigma_s = 0.0;
};

/// The target at one moment, given all bearings before and after it.
struct FlightStep {
  TargetState state;
  std::vector<ReceiverError> receivers;  ///< in the order of the receivers given
  int seen_by = 0;                       ///< receivers that saw the target within seen_s
};

struct FlightPath {
  std::vector<FlightStep> steps;  ///< every step_s
  int passes = 0;
};

/// The path of one target from dense bearings, none of them simultaneous, and with it what the receivers' clocks and
/// directions are off by, without truth: the most probable path with accelerations that fade, directions that wander as
/// far as Receiver::pose_covariance allows, and clocks that start within ReceiverClock::covariance and walk off. All
/// that is in the states' covariances; a clock without covariance stands. Every bearing is taken at its own time. A
/// smoother over the whole flight (Rauch, Tung and Striebel), linear about the path of the pass before, the first one
/// about where bearings meet. Bearings in order of time, all of one target; their own covariance is the noise alone.
/// Empty where the bearings of no two receivers meet. Throws std::invalid_argument for fewer than two receivers,
/// bearings of none of them, or not in order. Source: UAV paper page, "Where we go past it", 1 and 4.
std::optional<FlightPath> estimate_flight(std::span<const Receiver> receivers, std::span<const Bearing> bearings,
                                          const FlightPathOptions& options = {});

/// The target at any moment, by the step nearest to it; empty more than half a step outside the path.
std::optional<TargetState> state_at(const FlightPath& path, Timestamp time);

/// The step nearest to `time`; null more than half a step outside the path.
const FlightStep* step_at(const FlightPath& path, Timestamp time);

}  // namespace alidade
