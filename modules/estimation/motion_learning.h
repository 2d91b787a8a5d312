// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "estimation/motion_step.h"

namespace alidade {

/// The motion process under which recordings, filtered with `motion`, are more probable: one step of expectation and
/// maximisation of the innovation likelihood (as the steps have weighed it: kCaution included), for the modes' weights
/// and what each has of jerk or jump (of one of them, not of both). No truth is needed. Returned as it is where there
/// are fewer than ten steps. Source: Shumway and Stoffer 1982.
MotionProcess learned(const MotionProcess& motion, std::span<const std::vector<MotionStep>> recordings);

/// The best of such steps, until two in a row gain less than 2 in log evidence (more would be learned by heart), at
/// most `most_steps`; `filter` gives the recordings as filtered with a motion process.
MotionProcess learn_motion(MotionProcess motion, int most_steps,
                           const std::function<std::vector<std::vector<MotionStep>>(const MotionProcess&)>& filter);

}  // namespace alidade
