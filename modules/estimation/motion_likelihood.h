// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/motion_state.h"

namespace alidade {

/// What measurements spread over a short time say of a state, to second order: log p(z | moved_by(at, e)) =
/// log_density + gradientᵀ e - ½ eᵀ information e. They may determine it in part only.
struct MotionLikelihood {
  MotionState at;  ///< its covariance is not looked at
  Matrix18d information = Matrix18d::Zero();
  Vector18d gradient = Vector18d::Zero();
  double log_density = 0.0;  ///< at `at`, up to a constant of the measurements
};

/// The same likelihood as a function of the error of another state at the same time.
MotionLikelihood about(const MotionState& state, const MotionLikelihood& likelihood);

/// The state after the measurements, with its covariance: the Kalman update in information form. The map's offset is
/// not considered.
MotionState absorb(const MotionState& predicted, const MotionLikelihood& likelihood);

/// The log of the probability density that a prediction of this covariance gives to the measurements, up to the same
/// constant. `about_prediction` is about the prediction.
double log_evidence(const Matrix18d& covariance, const MotionLikelihood& about_prediction);

/// L with L Lᵀ = covariance; for a covariance that may be singular.
Matrix18d covariance_root(const Matrix18d& covariance);

/// J of an error's reset: an error e + d of `from` is the error J d of moved_by(from, e).
Matrix18d reset_jacobian(const Vector18d& e);

}  // namespace alidade
