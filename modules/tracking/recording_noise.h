// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "estimation/motion_step.h"

namespace alidade {

/// What the sightings of one frame of a recording say of its pose; without information where there are none.
struct FrameLikelihood {
  Timestamp time{};
  PoseLikelihood sightings;
};

/// What a recording is learned to be like.
struct RecordingNoise {
  MotionProcess motion;
  /// Covariance of what all sightings of a frame are off by together, as a perturbation of its pose (m and rad): errors
  /// that neighbours in the map share, blur, what is left of a rolling shutter. Independent from frame to frame.
  Matrix6d pose = Matrix6d::Zero();
};

/// RecordingNoise::pose where nothing has been learned yet: loose, from what these sightings claim of their pose.
Matrix6d guessed_pose_noise(const PoseLikelihood& sightings);

/// What sightings say of a pose if they are off together by an error of this covariance: (Λ⁻¹ + R)⁻¹ in place of Λ.
PoseLikelihood blurred(const PoseLikelihood& sightings, const Matrix6d& covariance);

/// The steps from `first` through the frames of a recording, one per frame.
std::vector<MotionStep> filter_recording(const MotionState& first, std::span<const FrameLikelihood> frames,
                                         const RecordingNoise& noise);

/// The noise under which a recording is more probable: `steps` of expectation and maximisation, from `noise` on. No
/// truth is needed. As it is where there are fewer than ten frames.
/// Source: Shumway and Stoffer 1982.
RecordingNoise learned(RecordingNoise noise, const MotionState& first, std::span<const FrameLikelihood> frames,
                       int steps);

}  // namespace alidade
