// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "camera/measurement.h"
#include "uav/batch/motion_fit.h"

namespace alidade {

/// What is known of receivers and targets before a window of bearings is told apart.
struct WindowOptions {
  /// Each receiver sees a target at most once in a period; a scan is what one receiver saw in one period, counted from
  /// the window's first bearing. 0: a scan is what one receiver saw at the very same time (frames of a camera).
  double period_s = 1.0;
  double detection_probability = 0.9;   ///< of a target in a scan
  double false_bearings_per_sr = 10.0;  ///< their mean number in a scan, per steradian; 10: one in a cone of 20°
  /// Targets that there may be before anything is seen, per cubic metre: 1e-5 is one in a cube of 46 m.
  double target_density_m3 = 1e-5;
  /// That a target comes or goes within the window, instead of being missed there.
  double appearance_probability = 0.01;
  double top_speed_m_s = 70.0;
  double greatest_range_m = 1e4;  ///< of a target from a receiver
  /// How far off (χ² of two degrees of freedom) a bearing of a target may be: 16 loses one in 3000.
  double gate_chi2 = 16.0;
  /// Of an accepted hypothesis, natural logarithm: how much more probable a target is than false bearings alone. 0
  /// makes the fewest errors of both kinds if all else is as stated; 2 favours no target a little.
  double least_log_ratio = 2.0;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const WindowOptions& options);

/// A target that a window of bearings tells of.
struct TargetHypothesis {
  MotionFit fit;                      ///< at the time of the window's last bearing
  std::vector<std::size_t> bearings;  ///< their places in the window, ascending; no two of one scan
  double log_likelihood_ratio = 0.0;  ///< of this target against false bearings, its prior density included
};

/// Tells apart the targets of a window: how many there are, where each flies (straight on), and which bearings are of
/// it. Any number of receivers >= 2, any times, missed detections, false bearings. No bearing is of two targets; the
/// greatest log-likelihood ratio comes first. Empty where nothing is more probable than false bearings. Every target is
/// taken to be in every receiver's view. A window is as long as targets fly straight on to within the bearings' noise;
/// some five scans of each receiver are enough.
/// Throws std::invalid_argument as fit_motion does, and for bad options.
/// Source: UAV paper page, "Where we go past it", 2.
std::vector<TargetHypothesis> associate_window(std::span<const Bearing> bearings, const WindowOptions& options = {});

}  // namespace alidade
