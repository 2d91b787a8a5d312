// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/experiments/experiment_section.h"

namespace alidade {

// The 1D-marker paper's experiments and what goes beyond them, on the scene of its page. ExperimentContext::runs is the
// number of frames, or of trials, of each cell.

/// Clean data: 3, 4 and 8 markers; and the paper's Fig. 2: accuracy against the number of detectors, three against four
/// markers.
ExperimentSection body_accuracy(const ExperimentContext& context);

/// Wrong ids, 0 to 45 %.
ExperimentSection body_wrong_ids(const ExperimentContext& context);

/// Occlusion in bursts, 0 to 60 % of readings; padding against a prior, forward against backward.
ExperimentSection body_occlusion(const ExperimentContext& context);

/// Derivatives, exact recovery, and the agreement of the paper's solver, ours and Ceres.
ExperimentSection body_solvers(const ExperimentContext& context);

/// The pose without a prior: whether what is called certain is right, and how many poses few planes leave.
ExperimentSection body_start(const ExperimentContext& context);

/// From rendered line images of blinking markers: identities, positions of spots, and poses beside those from exact
/// planes with the same noise.
ExperimentSection body_lines(const ExperimentContext& context);

/// The whole loop from a CSV file to poses.
ExperimentSection body_speed(const ExperimentContext& context);

}  // namespace alidade
