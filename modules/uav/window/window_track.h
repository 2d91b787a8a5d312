// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "uav/batch/motion_solver.h"
#include "uav/window/window_scans.h"

namespace alidade {

constexpr std::size_t kNoBearing = static_cast<std::size_t>(-1);

/// A target among a window's scans.
struct WindowTrack {
  MotionSolution<6> motion;
  std::vector<std::size_t> bearing_of_scan;  ///< kNoBearing where the scan has none of it
  double log_ratio = 0.0;                    ///< TargetHypothesis::log_likelihood_ratio
};

/// How far off (χ² of two degrees of freedom) a bearing is that the motion does not know of yet; infinite where it
/// cannot be of it.
double innovation_chi2(const BearingWindow& window, std::size_t bearing, const MotionSolution<6>& motion);

/// The motion of the track's own bearings, and log_ratio, anew. False where there is none within the options' bounds.
bool refit(const BearingWindow& window, WindowTrack& track);

/// The track that a few bearings grow to: a fit, the free bearing nearest to it in each scan within the gate, a fit of
/// these, until nothing changes. Empty where no motion is determined.
std::optional<WindowTrack> grow_track(const BearingWindow& window, std::span<const std::size_t> seed,
                                      const std::vector<char>& is_free);

}  // namespace alidade
