// SPDX-License-Identifier: Apache-2.0
#include "tests/support/motion_states.h"

#include "geometry/rotation.h"

namespace alidade::test {

Eigen::MatrixXd random_covariance(RandomGeometry& random, int size, double sigma) {
  Eigen::MatrixXd A(size, size);
  for (double& value : A.reshaped()) value = random.normal(sigma);
  return A * A.transpose();
}

MotionState random_state(RandomGeometry& random, double sigma) {
  MotionState state;
  state.T_world_body = random.pose();
  state.v_world = random.vector();
  state.omega_body = random.vector();
  state.a_world = random.vector();
  state.alpha_body = random.vector();
  state.covariance = random_covariance(random, 18, sigma);
  return state;
}

MotionState random_unaccelerated_state(RandomGeometry& random, double sigma) {
  MotionState state = random_state(random, sigma);
  state.a_world.setZero();
  state.alpha_body.setZero();
  state.covariance.bottomRows<6>().setZero();
  state.covariance.rightCols<6>().setZero();
  return state;
}

MotionState jumped(MotionState state, const Vector6d& jump) {
  state.a_world += jump.head<3>();
  state.alpha_body += jump.tail<3>();
  return state;
}

MotionState driven(const MotionState& state, double dt, const Vector6d& acceleration, const Vector6d& jerk) {
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
