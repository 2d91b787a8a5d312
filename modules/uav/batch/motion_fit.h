// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "camera/measurement.h"
#include "uav/target_state.h"

namespace alidade {

enum class MotionModel {
  Velocity,      ///< straight on: position and velocity, 6 unknowns
  Acceleration,  ///< along a parabola: 9 unknowns
};

struct MotionFitOptions {
  MotionModel model = MotionModel::Velocity;
  /// Of the state; empty: the time of the last bearing.
  std::optional<Timestamp> time;
  /// What is known beforehand, of the moment that it names; its position and velocity (and, by the acceleration model,
  /// acceleration) need a positive definite covariance.
  std::optional<TargetState> prior;
  /// Bearings that are off by so many sigma get half the weight, those farther off less (Cauchy's weights); 0: all get
  /// their full weight. 2.5 keeps 95 % of the precision where nothing is wrong.
  double robust_scale = 0.0;
  /// A fit whose range is less sure than this share of itself (1 sigma, from the nearest receiver) is not determined:
  /// there the bearings are far from linear in it, and its covariance means little.
  double greatest_range_sigma = 0.1;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const MotionFitOptions& options);

/// The motion that bearings tell.
struct MotionFit {
  TargetState state;  ///< with covariance; the acceleration's is 0 by the velocity model
  double chi2 = 0.0;  ///< of the bearings' whitened errors and of the prior
  int degrees = 0;    ///< of freedom of chi2: equations less unknowns
};

enum class MotionOutcome {
  Determined,
  TooFew,          ///< fewer equations than unknowns
  Undetermined,    ///< such as one receiver alone, or lines of sight in one plane
  BehindReceiver,  ///< the motion that fits best passes behind a receiver that saw it before itself
  NotConverged,
};

/// The fit where there is one; else why there is none.
struct MotionAnswer {
  MotionOutcome outcome = MotionOutcome::TooFew;
  std::optional<MotionFit> fit;
};

/// The most probable motion of one target from bearings by any number of receivers at any times: a linear start, its
/// weights by range, then Gauss–Newton on the bearings' own errors; where these are small, as precise as any unbiased
/// estimate can be. The bearings need no order.
/// Throws std::invalid_argument for a direction that is not of unit length, a covariance that is not positive definite,
/// and for a value that is not finite.
/// Source: UAV paper page, "Where we go past it", 1; the paper's eqs. 4 and 5 for the motion between the bearings.
MotionAnswer fit_motion(std::span<const Bearing> bearings, const MotionFitOptions& options = {});

}  // namespace alidade
