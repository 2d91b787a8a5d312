// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "datasets/body_scene.h"
#include "estimation/line_bound.h"
#include "geometry/trajectory.h"

namespace alidade {

/// One simulated recording of an experiment: the first body of a scene.
struct BodyRecording {
  std::vector<LineDetector> detectors;
  RigidBody body;
  std::vector<BodySceneFrame> frames;
  std::vector<std::optional<PoseBound>> bounds;  ///< of each frame's right readings, where they tell the pose to 1 cm
};

/// Adds the bounds to what was recorded of the scene's first body.
BodyRecording recording_of(std::vector<LineDetector> detectors, RigidBody body, std::vector<BodySceneFrame> frames);

BodyRecording record_body(const BodySceneOptions& options);

/// One per frame; empty where the method does not answer.
using BodyAnswers = std::vector<std::optional<StampedPose>>;

/// The seed paper's method, forward and then refined backward.
struct PaperAnswers {
  BodyAnswers forward, backward;
};
PaperAnswers track_by_paper(const BodyRecording& recording);

/// Our filter, and the smoother behind it with a lag of half a second.
struct OurAnswers {
  BodyAnswers forward, smoothed;
};
OurAnswers track_by_ours(const BodyRecording& recording);

/// How far answers are from the truth.
struct BodyScore {
  double answered_share = 0.0;
  double rms_m = 0.0, worst_m = 0.0;  ///< of the position, over all answers
  double rms_rad = 0.0;
  double position_to_bound = 0.0;  ///< RMS over the bound's, of frames that have one
  double rotation_to_bound = 0.0;
  std::optional<double> nees_per_dof;  ///< of methods that tell their covariance
};
BodyScore score_of(const BodyRecording& recording, const BodyAnswers& answers);

}  // namespace alidade
