// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "camera/receiver.h"
#include "uav/tracker/bearing_filter.h"

namespace alidade {

/// How a receiver that has to be pointed gets there.
struct SteeredReceiver {
  Receiver receiver;
  double slew_rad_s = 1.0;  ///< how fast it turns
  double settle_s = 0.0;    ///< and how long it then takes until it can read
  /// Where it looks when it is told, in its axes (receiver.h), rad; empty: straight ahead, (0, 0).
  std::optional<Eigen::Vector2d> azimuth_elevation;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const SteeredReceiver& steered);

/// Where a receiver has to look, and when it will look there.
struct Cue {
  Timestamp time{};                                             ///< of the common clock
  Timestamp own_time{};                                         ///< the same by the receiver's own clock
  Eigen::Vector2d azimuth_elevation = Eigen::Vector2d::Zero();  ///< in the receiver's axes, rad
  /// Of the target about it, rad², with the receiver's pose covariance where it has one. Near the zenith an azimuth
  /// means little: its variance then grows without bound.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double range_m = 0.0;
};

/// Where the receiver will see the target of `state` at a moment. Empty where the target is at the receiver, or right
/// above or below it.
std::optional<Cue> cue_at(const Receiver& receiver, const TargetState& state, Timestamp time,
                          const TargetMotion& motion = {});

/// The first moment from `told` on at which the receiver can look at the target, that flies on while the receiver
/// turns. Empty where the target outruns it, for longer than `most_s`, and where cue_at is. Source: UAV paper, eq. 3
/// and how the optical receivers point the radio-thermal one.
std::optional<Cue> cue_for(const SteeredReceiver& steered, const TargetState& state, Timestamp told,
                           const TargetMotion& motion = {}, double most_s = 5.0);

}  // namespace alidade
