// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/experiments/experiment_section.h"

namespace alidade {

// The camera tracker on recordings with truth. Both throw InputError where the folder is not one.

/// The paper's Fig. 6 to 8: stills, their map made on the way from the first two true poses, by each method.
ExperimentSection camera_stills(const std::filesystem::path& stills, const ExperimentContext& context);

/// Video in a known map: frames at intervals are lifted by their depth at their true pose, the others tracked among
/// those points; against PnP in RANSAC on the same matches.
ExperimentSection camera_known_map(const std::filesystem::path& video, const ExperimentContext& context);

}  // namespace alidade
