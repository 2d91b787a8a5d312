// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "camera/measurement.h"
#include "uav/batch/motion_fit.h"
#include "uav/target_state.h"

namespace alidade {

/// Fisher information of (p, v, a) at truth.time (m, m/s, m/s²; world axes) in bearings of a target that moves as
/// `truth` says; of each bearing, origin, time and covariance count, and the direction is the true one.
/// Throws std::invalid_argument for a covariance that is not positive definite and a target at an origin.
Matrix9d motion_information(const TargetState& truth, std::span<const Bearing> bearings);

/// Its inverse for the model's unknowns (the rest 0): the least covariance at truth.time that an unbiased estimate can
/// have (Cramér–Rao). Empty where the motion is not determined.
/// Source: UAV paper page, "Where we go past it"; the paper's eqs. 12 and 13 for any receivers and times.
std::optional<Matrix9d> motion_bound(const TargetState& truth, std::span<const Bearing> bearings, MotionModel model);

}  // namespace alidade
