// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "estimation/pose_update.h"
#include "tracking/camera_state.h"
#include "tracking/motion_noise.h"

namespace alidade {

/// What the residuals of all frames so far say of the sightings' noise.
struct SightingNoise {
  double variance = 1.0;            ///< factor on the observations' own sigma_px²
  double degrees_of_freedom = 0.0;  ///< of the residuals that it rests on; 0: it is a guess
};

/// One step of the filter: what was expected of the frame, and what it has brought.
struct FilterStep {
  CameraState predicted;  ///< by the modes of the motion as the frame has weighed them
  CameraState state;
  PoseUpdate update;                ///< before the modes are weighed; the inliers are from here
  SightingNoise noise;              ///< after the frame
  std::vector<double> mode_weight;  ///< probability of each mode of the motion, given the frame
  double log_evidence = 0.0;        ///< of the sightings, given the prediction: innovation likelihood
};

struct CameraFilterOptions {
  PoseUpdateOptions update;
  MotionProcess motion;  ///< at least one mode; the first is the calm one
  double caution = 2.0;  ///< on the odds of the other modes: to miss a manoeuvre costs more than to fear one
  bool learn_sighting_noise = true;  ///< false: SightingNoise stays as it is given
};

/// Predicts the state to `time` and takes in the frame's observations. The modes of the motion are weighed by the
/// innovation likelihood of this frame, so that a manoeuvre is followed in the frame where it begins; the noise of
/// the sightings is learned from their residuals. Empty where the observations give no pose.
/// Source: camera-tracker paper eqs. 1–13 in error-state information form.
std::optional<FilterStep> filter_step(const Camera& camera, const CameraState& state, const SightingNoise& noise,
                                      Timestamp time, std::span<const PointObservation> observations,
                                      const CameraFilterOptions& options);

}  // namespace alidade
