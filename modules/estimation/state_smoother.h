// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "estimation/motion_step.h"

namespace alidade {

/// What later frames say of a state.
struct SmoothedState {
  MotionState state;
  Matrix18d with_next = Matrix18d::Zero();  ///< covariance of its error with that of the next; zero for the last
};

/// The states of consecutive steps given all of them, one per step: backward pass of Rauch, Tung and Striebel 1965 on
/// the error state.
std::vector<SmoothedState> smooth(std::span<const MotionStep> steps);

/// The states with a lag of `lag` frames: each given the steps up to that many after it; -1: given all.
std::vector<MotionState> smoothed_states(std::span<const MotionStep> steps, int lag);

}  // namespace alidade
