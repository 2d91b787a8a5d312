// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "camera/measurement.h"
#include "estimation/motion_state.h"

namespace alidade {

/// What independent errors of the observed points do to the map as a rigid body: every frame that sees these points
/// sees them displaced alike. None (zero covariance) where a point is exact or where they do not determine it.
MapOffset rigid_offset(std::span<const PointObservation> observations);

/// The observations with what the offset explains taken out of their points' covariance.
std::vector<PointObservation> apart_from(const MapOffset& offset, std::vector<PointObservation> observations);

}  // namespace alidade
