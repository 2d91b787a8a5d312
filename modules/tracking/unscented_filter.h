// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "estimation/motion_state.h"

namespace alidade {

/// How the sigma points lie; kappa is 0.
struct UnscentedOptions {
  double alpha = 1e-3;  ///< they lie at alpha √6 standard deviations; at most √beta
  double beta = 2.0;    ///< weight of the mean's shift in the covariance; 2 is best for a Gaussian
};

/// What the sightings say of the pose by the scaled unscented transform, about the prediction's pose: the Gaussian that
/// leads from the prediction to the unscented filter's estimate. R = σ²I. A point that the camera does not see from
/// every sigma point is left out. Throws std::invalid_argument where alpha is not in (0, √beta].
/// Pixels depend on the pose alone: of all sigma points of the state (in the tangent space, by the Cholesky factor with
/// the pose first) these are the 13 that show different ones, spread as for six dimensions.
/// Source: Julier and Uhlmann 1997; Wan and van der Merwe 2000.
PoseLikelihood unscented_likelihood(const Camera& camera, const MotionState& predicted,
                                    std::span<const PointObservation> observations,
                                    const UnscentedOptions& options = {});

/// One unscented Kalman update with R = σ²I; the velocities follow the pose as they are correlated with it.
MotionState update_unscented_filter(const Camera& camera, const MotionState& predicted,
                                    std::span<const PointObservation> observations,
                                    const UnscentedOptions& options = {});

}  // namespace alidade
