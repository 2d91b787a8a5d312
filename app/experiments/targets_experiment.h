// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/experiments/experiment_section.h"

namespace alidade {

// The UAV paper's experiments and what goes beyond them, on the scenes of its page. ExperimentContext::runs is the
// number of runs of each cell.

/// The paper's Tables 1 and 2: printed, re-created on the page, re-created here in both readings of the noise; the
/// stamped batch on the same bearings, and the bound.
ExperimentSection targets_tables(const ExperimentContext& context);

/// The paper's formulas 12 and 13 against Monte Carlo covariances, under their own noise and under that of bearings.
ExperimentSection targets_formulas(const ExperimentContext& context);

/// The stamped batch's errors against the Cramér–Rao bound and its own covariance, by receivers and motion model.
ExperimentSection targets_batch(const ExperimentContext& context);

/// A window of bearings with misses and false ones told apart, by number of targets, probability of detection, false
/// bearings, delays and receivers; an oracle beside.
ExperimentSection targets_window(const ExperimentContext& context);

/// The placement map's bound against Monte Carlo errors, at ten places.
ExperimentSection targets_placement(const ExperimentContext& context);

/// The recursive tracker: against the same filter with true association and against the bound; clutter, detection,
/// spacing, receivers, order of arrival, ways of scanning.
ExperimentSection targets_tracker(const ExperimentContext& context);

/// Where a receiver that has to turn will see a target: the error of the predicted direction against its covariance, by
/// lead time and by way of moving; and the rotating and cued ways of scanning that such receivers make.
ExperimentSection targets_cue(const ExperimentContext& context);

/// From rendered videos: detection of small moving objects by size and SNR, OpenCV's MOG2 beside it, and the chain from
/// pixels to tracks. ExperimentContext::runs is the number of frames of each cell, in videos of 150.
ExperimentSection targets_video(const ExperimentContext& context);

/// On a recorded flight with truth (read_flight): accuracy with poses and clocks of the half on which they were fitted,
/// delays, the spline bundle, the checks. Throws InputError where the folder is none.
ExperimentSection targets_recording(const std::filesystem::path& recording, const ExperimentContext& context);

}  // namespace alidade
