// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/geometry/random_geometry.h"
#include "tracking/camera_state.h"

namespace alidade::test {

using Vector12d = Eigen::Matrix<double, 12, 1>;

/// A state moved by an error in the order of its covariance.
inline CameraState moved(CameraState state, const Vector12d& error) {
  state.T_world_camera = state.T_world_camera * perturbation(error.head<6>());
  state.v_world += error.segment<3>(6);
  state.omega_camera += error.tail<3>();
  return state;
}

/// The error that moves `from` to `to`.
inline Vector12d error_between(const CameraState& from, const CameraState& to) {
  Vector12d error;
  error << difference(from.T_world_camera, to.T_world_camera), to.v_world - from.v_world,
      to.omega_camera - from.omega_camera;
  return error;
}

/// A random pose with velocities of about 1 m/s and 1 rad/s, all correlated; `sigma` scales the standard deviations.
inline CameraState random_state(RandomGeometry& random, double sigma) {
  CameraState state;
  state.T_world_camera = random.pose();
  state.v_world = random.vector();
  state.omega_camera = random.vector();
  Matrix12d A;
  for (double& value : A.reshaped()) value = random.normal(sigma);
  state.covariance = A * A.transpose();
  return state;
}

}  // namespace alidade::test
