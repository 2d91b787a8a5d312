// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tracking/frame.h"

namespace alidade {

struct TrackSmoothingOptions {
  int lag = -1;                ///< frames after it by which a pose goes; -1: all of the recording
  double longest_gap_s = 0.5;  ///< without an image, beyond which the motion before says nothing of that after
};

/// The poses of frames without a gap in time given their neighbours' as well, by the motion's noise as these frames
/// themselves speak for it; keyframes stay, and what was lost. For reports whose times mean seconds.
/// Source: Rauch, Tung and Striebel 1965; noise by expectation maximisation (Shumway and Stoffer 1982).
std::vector<FrameReport> smoothed(std::vector<FrameReport> reports, const TrackSmoothingOptions& options = {});

}  // namespace alidade
