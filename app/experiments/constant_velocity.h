// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "app/experiments/camera_runs.h"

namespace alidade {

/// moving_state() as the paper's model has it: without accelerations.
MotionState constant_velocity_start(const Trajectory& truth);

/// What a filter makes of a prediction and a frame.
using FrameUpdate =
    std::function<MotionState(const MotionState& predicted, std::span<const PointObservation> observations)>;

/// Poses from the third frame on of a filter that starts from a state at the second; all such filters predict alike.
Trajectory estimate_at_constant_velocity(const CameraRun& run, MotionState start, const MotionNoise& noise,
                                         const FrameUpdate& update);

/// The same with the run's points in the filter's state.
Trajectory estimate_with_map_in_state(const Camera& camera, const CameraRun& run, const MotionState& start,
                                      const MotionNoise& noise);

/// Our iterated update with every sighting taken in; what the points of an uncertain map have in common is considered
/// where the state has an offset.
FrameUpdate iterated_update(const Camera& camera);

/// The run with the sightings' true standard deviation in them.
CameraRun with_sigma(CameraRun run, double sigma_px);

}  // namespace alidade
