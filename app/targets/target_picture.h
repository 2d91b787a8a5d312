// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "app/targets/target_record.h"
#include "view/plot.h"
#include "view/scene.h"

namespace alidade {

/// What a track of targets looks like: receivers (pyramids), some of their lines of sight, the path of each target with
/// its name and ellipsoids of its position's covariance. `truth` (may be empty) lies beside it. World z is up.
Scene scene_of(const TargetRun& run, std::span<const TargetRow> truth);

/// Paths from above, height and the position's standard deviation over time, of the targets that were seen longest.
std::vector<Plot> plots_of(const TargetRun& run, std::span<const TargetRow> truth);

}  // namespace alidade
