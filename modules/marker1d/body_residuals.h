// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marker1d/body_readings.h"

namespace alidade {

/// How far a reading is from what a body's state lets expect.
struct ReadingResidual {
  double value = 0.0;  ///< read minus expected, in the detector's unit (rad, px)
  double sigma = 0.0;  ///< standard deviation of the reading, in the same unit
};

/// The residual of each reading, at its own time under the state's constant acceleration: the batch by batch model of
/// BodyReadings. Empty where the detector would not see the marker. Throws std::invalid_argument for a detector or
/// marker that is not there.
std::vector<std::optional<ReadingResidual>> residuals_of(const DetectorArray& detectors, const RigidBody& body,
                                                         std::span<const LineReading> readings,
                                                         const MotionState& state);

}  // namespace alidade
