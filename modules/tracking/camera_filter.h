// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "estimation/motion_noise.h"
#include "estimation/motion_state.h"
#include "estimation/motion_step.h"
#include "estimation/pose_update.h"

namespace alidade {

/// What the residuals of all frames so far say of the sightings' noise.
struct SightingNoise {
  double variance = 1.0;            ///< factor on the observations' own sigma_px²
  double degrees_of_freedom = 0.0;  ///< of the residuals that it rests on; 0: it is a guess
};

/// One step of the filter.
struct FilterStep {
  MotionStep motion;
  PoseUpdate update;    ///< before the modes of the motion are weighed; the inliers are from here
  SightingNoise noise;  ///< after the frame
};

struct CameraFilterOptions {
  PoseUpdateOptions update;
  MotionProcess motion;              ///< at least one mode; the first is the calm one
  bool learn_sighting_noise = true;  ///< false: SightingNoise stays as it is given
};

/// Predicts the state to `time` and takes in the frame's observations; the noise of the sightings is learned from their
/// residuals. Empty where the observations give no pose.
/// Source: camera-tracker paper eqs. 1–13 in error-state information form.
std::optional<FilterStep> filter_step(const Camera& camera, const MotionState& state, const SightingNoise& noise,
                                      Timestamp time, std::span<const PointObservation> observations,
                                      const CameraFilterOptions& options);

}  // namespace alidade
