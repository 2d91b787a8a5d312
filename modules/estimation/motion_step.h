// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "estimation/motion_likelihood.h"
#include "estimation/motion_noise.h"
#include "estimation/motion_state.h"
#include "estimation/pose_update.h"

namespace alidade {

/// One step of a filtered motion: what was expected of a frame, and what is known with it.
struct MotionStep {
  MotionState predicted;  ///< by the modes of the motion as the frame has weighed them
  MotionState state;
  std::vector<double> mode_weight;  ///< probability of each mode of the motion, given the frame
  double log_evidence = 0.0;        ///< of the sightings, given the prediction: innovation likelihood
};

/// The odds at which a step is taken for another mode than the first, the calm one, are twice those of the motion
/// process: to miss a manoeuvre costs more than to fear one.
constexpr double kCaution = 2.0;

/// Where the body will be at `time`, whichever mode its motion is in: their mean, with the covariance of the mixture.
MotionState predict(const MotionState& state, Timestamp time, const MotionProcess& motion);

/// The state at `time` after the sightings of its frame. The modes of the motion are weighed by the innovation
/// likelihood of this frame, so that a manoeuvre is followed in the frame where it begins.
MotionStep absorb(const MotionState& state, Timestamp time, const MotionProcess& motion,
                  const PoseLikelihood& sightings);
MotionStep absorb(const MotionState& state, Timestamp time, const MotionProcess& motion,
                  const MotionLikelihood& measurements);

/// The step to a frame that shows nothing.
MotionStep pass(const MotionState& state, Timestamp time, const MotionProcess& motion);

}  // namespace alidade
