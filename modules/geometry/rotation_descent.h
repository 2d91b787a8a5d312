// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "geometry/plane_sums.h"

namespace alidade {

/// ½ E and its derivatives for the right perturbation R exp(φ), at φ = 0.
struct RotationSlope {
  double half_cost = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gauss_newton = Eigen::Matrix3d::Zero();  ///< the part of the Hessian that is never indefinite
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

RotationSlope slope(const RotationCost& cost, const Eigen::Matrix3d& R_world_body);

/// Where a descent on E ended.
struct RotationMinimum {
  Eigen::Matrix3d R_world_body = Eigen::Matrix3d::Identity();
  double cost = 0.0;                                  ///< E
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< of ½ E
  int steps = 0;                                      ///< evaluations of slope()
  bool is_minimum = false;  ///< otherwise max_steps did not suffice: a valley that is all but flat
};

/// Newton's method on SO(3) from a start near the minimum: two or three steps from an extrapolated pose, at the same
/// cost however many planes there are. Empty where a Hessian on the way is not positive (far from a minimum, or the
/// rotation is not determined) or ten steps do not suffice. Stops after a step below `last_step`: the error left is its
/// square. Source: marker1d paper page, f and J, here for the perturbation of R itself instead of P.
std::optional<Eigen::Matrix3d> newton_rotation(const RotationCost& cost, const Eigen::Matrix3d& start,
                                               double last_step = 1e-7);

struct RotationDescentOptions {
  int max_steps = 80;       ///< 6 to 14 are usual from an arbitrary rotation
  double last_step = 1e-7;  ///< rad; a step below it is the last
};

/// The minimum below any start: Newton where the Hessian is positive, else damped Gauss–Newton, never uphill.
RotationMinimum descend(const RotationCost& cost, const Eigen::Matrix3d& start,
                        const RotationDescentOptions& options = {});

}  // namespace alidade
