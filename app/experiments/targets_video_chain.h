// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/experiments/experiment_section.h"

namespace alidade {

/// From the videos of three cameras to tracks, beside tracks from true pixels with 0.5 px of noise in the same frames:
/// adds a table, and "chain" to the summary.
void add_video_chain(const ExperimentContext& context, ExperimentSection& section);

}  // namespace alidade
