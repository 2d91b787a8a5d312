// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "calib/detectors/motion_start.h"
#include "camera/measurement.h"
#include "geometry/rigid_body.h"

namespace alidade {

/// Detectors and markers in the order given.
DetectorScene scene_of(std::span<const LineDetector> detectors, const RigidBody& body);

/// The readings by the places of their detectors and markers in scene_of, each with its own standard deviation or its
/// detector's; those of unknown detectors and markers are left out.
std::vector<PlacedReading> place_readings(std::span<const LineDetector> detectors, const RigidBody& body,
                                          std::span<const LineReading> readings);

}  // namespace alidade
