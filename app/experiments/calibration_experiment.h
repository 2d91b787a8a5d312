// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/experiments/experiment_section.h"

namespace alidade {

/// Whether calibrations are as good as they say: ExperimentContext::runs sets of rendered images of a board, each
/// calibrated as `calibrate camera` does; how often the 90 % regions of projected pixels hold the truth, and the bias
/// of the focal length.
ExperimentSection calibration_coverage(const ExperimentContext& context);

/// The images of `source` in two halves, by turns: how far apart the two calibrations are, and how much of that they
/// state. Throws InputError as read_board_images does, and where a half cannot be calibrated.
ExperimentSection calibration_halves(const std::string& source, const std::string& board,
                                     const ExperimentContext& context);

}  // namespace alidade
