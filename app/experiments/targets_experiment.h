// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/experiments/experiment_section.h"

namespace alidade {

// The UAV paper's experiments and what goes beyond them, on the scenes of its page. ExperimentContext::runs is the
// number of runs of each cell.

/// The recursive tracker: against the same filter with true association and against the bound; clutter, detection,
/// spacing, receivers, order of arrival, ways of scanning.
ExperimentSection targets_tracker(const ExperimentContext& context);

}  // namespace alidade
