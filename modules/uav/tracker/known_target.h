// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "uav/tracker/target_tracker_options.h"

namespace alidade {

/// What the tracker's filter makes of bearings that are known to be of one target, in order of time: its state at each
/// of `times` (ascending) by the bearings up to then. Empty before it could start by the tracker's rules. What
/// association costs is the tracker's error beside this one's.
std::vector<std::optional<TargetState>> follow_known_target(std::span<const Bearing> of_it,
                                                            std::span<const Timestamp> times,
                                                            const TargetTrackerOptions& options = {});

/// The least covariance that any such filter can have (posterior Cramér–Rao), for a target of which `truth` tells the
/// state (its covariance is not looked at) and that moves by the options' motion: the states are the truth's, with the
/// bound as covariance. Empty where follow_known_target is.
/// Source: Tichavsky, Muravchik, Nehorai, Posterior Cramér-Rao bounds for discrete-time nonlinear filtering, 1998.
std::vector<std::optional<TargetState>> tracking_bound(std::span<const Bearing> of_it, std::span<const Timestamp> times,
                                                       const std::function<TargetState(Timestamp)>& truth,
                                                       const TargetTrackerOptions& options = {});

}  // namespace alidade
