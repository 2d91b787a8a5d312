// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "geometry/pose.h"

namespace alidade {

/// A motion that was measured without the truth, beside the truth's.
struct MotionResidual {
  Vector6d xi = Vector6d::Zero();          ///< moves the measured motion to the true one; its end's axes, m and rad
  Matrix6d covariance = Matrix6d::Zero();  ///< of the measured motion, same axes
};

/// Covariance of one true pose (right perturbation, m and rad), the errors of a motion's two ends taken as independent
/// and alike: half of what the residuals' second moment has beyond the mean covariance of the measured motions, its
/// negative eigenvalues set to zero. Empty for fewer than 7 residuals.
std::optional<Matrix6d> truth_covariance(std::span<const MotionResidual> residuals);

}  // namespace alidade
