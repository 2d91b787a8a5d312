// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "evaluation/association.h"
#include "evaluation/statistics.h"

namespace alidade {

// How far apart the two poses are whose motion is compared: in associated poses, along the path of the truth, or in
// time of the truth. All must be > 0.
struct FrameStep {
  std::size_t frames = 1;
};
struct PathStep {
  double metres = 1.0;
};
struct TimeStep {
  double seconds = 1.0;
};
using Step = std::variant<FrameStep, PathStep, TimeStep>;

/// From one pose to a later one; indices into the paired trajectories.
struct PoseSpan {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// From every pose the span to the first later one that is at least a step away; none where there is no such pose.
/// (evo's default makes spans of more than one frame not overlap.) Throws std::invalid_argument for a step that is not
/// positive.
std::vector<PoseSpan> spans(const Trajectory& truth, const Step& step);

/// How the motion over each span differs from the true one (RPE).
struct RelativeErrors {
  std::vector<PoseSpan> spans;
  ErrorSeries translation_m;  ///< length of the translation of (truth motion)⁻¹ (estimated motion)
  ErrorSeries rotation_deg;   ///< angle of its rotation
};

/// Throws std::invalid_argument for unequal lengths or a step that is not positive.
RelativeErrors relative_errors(const PairedTrajectories& pairs, const Step& step);

}  // namespace alidade
