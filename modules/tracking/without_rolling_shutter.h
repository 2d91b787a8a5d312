// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "estimation/motion_state.h"

namespace alidade {

/// The observations as a camera that moves like `state` would have made them had all its rows been exposed at once.
std::vector<PointObservation> without_rolling_shutter(const Camera& camera, const MotionState& state,
                                                      std::vector<PointObservation> observations);

}  // namespace alidade
