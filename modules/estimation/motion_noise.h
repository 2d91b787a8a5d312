// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "geometry/pose.h"

namespace alidade {

/// What the motion model leaves out: covariances of (translation in world axes, rotation in body axes), each held
/// over a step as in the paper's eqs. 5 and 6.
struct MotionNoise {
  Matrix6d acceleration = Matrix6d::Zero();  ///< that comes and goes with the step, (m/s², rad/s²)²
  Matrix6d jerk = Matrix6d::Zero();  ///< that changes the state's acceleration over the step, (m/s³, rad/s³)²
  Matrix6d jump = Matrix6d::Zero();  ///< that changes it as the step begins, (m/s², rad/s²)²
};

/// Alike along all axes; `linear` and `angular` are standard deviations (m and rad per s², or per s³).
Matrix6d isotropic_noise(double linear, double angular);

/// A way in which a body may move on, and how often it does.
struct MotionMode {
  MotionNoise noise;
  double weight = 1.0;  ///< of all modes together: 1
};

/// The modes of a motion: calm most of the time, a manoeuvre now and then. In every step it is one of them.
using MotionProcess = std::vector<MotionMode>;

/// A first guess, for learning to start from, where a body moves at `v` (m/s) and `omega` (rad/s) and is looked at
/// every `dt` seconds: calm, a manoeuvre (its pace changes within a step), and a jolt, for it may just have set off.
MotionProcess guessed_motion(double v, double omega, double dt);

/// The noise of all modes, each with its weight: its covariance is that of the mixture.
MotionNoise mean_noise(const MotionProcess& motion, std::span<const double> weights);
MotionNoise mean_noise(const MotionProcess& motion);

}  // namespace alidade
