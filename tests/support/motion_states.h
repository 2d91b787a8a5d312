// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/motion_state.h"
#include "geometry/rotation.h"
#include "tests/geometry/random_geometry.h"

namespace alidade::test {

/// A random covariance matrix with all of its entries about `sigma` squared times its size.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> random_covariance(RandomGeometry& random, double sigma) {
  Eigen::Matrix<double, kSize, kSize> A;
  for (double& value : A.reshaped()) value = random.normal(sigma);
  return A * A.transpose();
}

/// A random pose with velocities and accelerations of about 1 m/s, 1 rad/s, 1 m/s² and 1 rad/s², all correlated;
/// `sigma` scales the standard deviations.
inline MotionState random_state(RandomGeometry& random, double sigma) {
  MotionState state;
  state.T_world_body = random.pose();
  state.v_world = random.vector();
  state.omega_body = random.vector();
  state.a_world = random.vector();
  state.alpha_body = random.vector();
  state.covariance = random_covariance<18>(random, sigma);
  return state;
}

/// The same without accelerations, which are known to be zero: the paper's state.
inline MotionState random_unaccelerated_state(RandomGeometry& random, double sigma) {
  MotionState state = random_state(random, sigma);
  state.a_world.setZero();
  state.alpha_body.setZero();
  state.covariance.bottomRows<6>().setZero();
  state.covariance.rightCols<6>().setZero();
  return state;
}

/// A state whose accelerations have changed by (translation in world axes, rotation in camera axes).
inline MotionState jumped(MotionState state, const Vector6d& jump) {
  state.a_world += jump.head<3>();
  state.alpha_body += jump.tail<3>();
  return state;
}

/// Where a state goes in dt under an acceleration that is added to its own throughout, and a jerk, each (translation in
/// world axes, rotation in camera axes): the polynomials of kinematics. What the acceleration brings is the paper's
/// a Δt in velocity and a Δt² in place (eqs. 1, 5); it is gone when the step is over.
inline MotionState driven(const MotionState& state, double dt, const Vector6d& acceleration, const Vector6d& jerk) {
  MotionState next = state;
  next.time = state.time + from_seconds(dt);
  next.T_world_body.translation() +=
      dt * state.v_world + dt * dt * (state.a_world / 2 + acceleration.head<3>()) + dt * dt * dt / 6 * jerk.head<3>();
  next.T_world_body.linear() *=
      exp_so3(dt * state.omega_body + dt * dt * (state.alpha_body / 2 + acceleration.tail<3>()) +
              dt * dt * dt / 6 * jerk.tail<3>());
  next.v_world += dt * (state.a_world + acceleration.head<3>()) + dt * dt / 2 * jerk.head<3>();
  next.omega_body += dt * (state.alpha_body + acceleration.tail<3>()) + dt * dt / 2 * jerk.tail<3>();
  next.a_world += dt * jerk.head<3>();
  next.alpha_body += dt * jerk.tail<3>();
  return next;
}

}  // namespace alidade::test
