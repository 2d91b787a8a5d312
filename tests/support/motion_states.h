// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/motion_state.h"
#include "tests/geometry/random_geometry.h"

namespace alidade::test {

/// A random covariance matrix, size×size, with all of its entries about `sigma` squared times its size.
Eigen::MatrixXd random_covariance(RandomGeometry& random, int size, double sigma);

/// A random pose with velocities and accelerations of about 1 m/s, 1 rad/s, 1 m/s² and 1 rad/s², all correlated;
/// `sigma` scales the standard deviations.
MotionState random_state(RandomGeometry& random, double sigma);

/// The same without accelerations, which are known to be zero: the paper's state.
MotionState random_unaccelerated_state(RandomGeometry& random, double sigma);

/// A state whose accelerations have changed by (translation in world axes, rotation in camera axes).
MotionState jumped(MotionState state, const Vector6d& jump);

/// Where a state goes in dt under an acceleration that is added to its own throughout, and a jerk, each (translation in
/// world axes, rotation in camera axes): the polynomials of kinematics. What the acceleration brings is the paper's
/// a Δt in velocity and a Δt² in place (eqs. 1, 5); it is gone when the step is over.
MotionState driven(const MotionState& state, double dt, const Vector6d& acceleration, const Vector6d& jerk);

}  // namespace alidade::test
