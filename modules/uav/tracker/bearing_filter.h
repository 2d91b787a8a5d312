// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "camera/measurement.h"
#include "uav/target_state.h"

namespace alidade {

/// How targets leave the straight path: white noise, alike along all axes.
struct TargetMotion {
  /// Spectral density of an acceleration that changes from moment to moment, m²/s³: a velocity wanders by its root in
  /// a second. 0.1: steady flight in a light wind; 1 to 10: a drone that manoeuvres; 0: straight on.
  double acceleration_density = 0.1;
  /// Spectral density of a jerk, m²/s⁵, of targets whose acceleration is estimated too. 0: they have none to estimate.
  double jerk_density = 0.0;
};

struct BearingFilterOptions {
  TargetMotion motion;
  /// What the bearings' own covariance does not know of, such as errors of receivers' poses; added to it, rad.
  double added_sigma_rad = 0.0;
  /// Linearisations of one bearing at most; the second one matters only where the range is unsure.
  int max_iterations = 3;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const BearingFilterOptions& options);

/// The state at another time with what the motion's noise adds to its covariance; back in time it adds nothing.
TargetState predict(const TargetState& state, Timestamp time, const TargetMotion& motion);

/// What a bearing tells that was not known before.
struct BearingInnovation {
  /// Tangents of the angles from the bearing to where the state is expected, along tangent_basis(direction_world).
  Eigen::Vector2d residual;
  Eigen::Matrix2d covariance;                ///< expected of the residual: the state's and the bearing's, rad²
  Eigen::Matrix<double, 2, 3> J_residual_p;  ///< ∂residual/∂p_world, rad/m
  Eigen::Matrix<double, 9, 2> with_state;    ///< covariance of the state (p, v, a) with the residual
  double chi2 = 0.0;                         ///< of 2 degrees of freedom
  double log_density = 0.0;                  ///< ln of the probability density of the residual, 1/sr
};

/// Of a state that is predicted to the bearing's time already. Empty where the state is behind the receiver, seen from
/// the bearing, and where it is at the receiver.
std::optional<BearingInnovation> innovation_of(const TargetState& predicted, const Bearing& bearing,
                                               double added_sigma_rad = 0.0);

/// The state after the bearing: iterated extended Kalman update with Joseph's form of the covariance. `predicted` is at
/// the bearing's time, `innovation` between them.
TargetState absorb(const TargetState& predicted, const Bearing& bearing, const BearingInnovation& innovation,
                   const BearingFilterOptions& options = {});

/// A filter over bearings of one target, in order of time: the state at the last one's time. Those that the state
/// cannot have (innovation_of is empty) change nothing.
TargetState filter_bearings(TargetState state, std::span<const Bearing> bearings,
                            const BearingFilterOptions& options = {});

}  // namespace alidade
