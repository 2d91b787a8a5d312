// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "tracking/camera_filter.h"

namespace alidade {

/// What later frames say of a state.
struct SmoothedState {
  CameraState state;
  Matrix18d with_next = Matrix18d::Zero();  ///< covariance of its error with that of the next; zero for the last
};

/// The states of consecutive steps given all of them, one per step: backward pass of Rauch, Tung and Striebel 1965 on
/// the error state. The first of the last n + 1 steps is the estimate with a lag of n frames.
std::vector<SmoothedState> smooth(std::span<const FilterStep> steps);

}  // namespace alidade
