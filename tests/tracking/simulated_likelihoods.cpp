// SPDX-License-Identifier: Apache-2.0
#include "tests/tracking/simulated_likelihoods.h"

#include <Eigen/LU>

namespace alidade::test {

SimulatedLikelihoods simulated_likelihoods(int count, const Matrix6d& common, RandomGeometry& random) {
  const Matrix6d claim = isotropic_noise(2e-4, 2e-4);
  SimulatedLikelihoods simulated;
  for (int k = 0; k < count; ++k) {
    const double t = k / 30.0;
    Vector6d sway;
    sway << 0.2 * std::sin(t), 0.1 * std::cos(1.3 * t), 0.15 * std::sin(0.7 * t), 0.2 * std::sin(1.1 * t),
        0.1 * std::cos(t), 0.1 * std::sin(0.9 * t);
    const Eigen::Isometry3d T = perturbation(sway);
    simulated.truth.push_back({Timestamp(from_seconds(t)), T, {}});
    const Matrix6d P = claim + common;
    simulated.frames.push_back(
        {Timestamp(from_seconds(t)), {T * perturbation(drawn(random, P)), claim.inverse(), Vector6d::Zero()}});
  }
  return simulated;
}

MotionState before_likelihoods(const SimulatedLikelihoods& simulated) {
  MotionState state = resting_state(simulated.truth[0].time, simulated.frames[0].sightings.T_world_body,
                                    isotropic_noise(0.1, 0.1), 1.0, 1.0);
  state.covariance.block<6, 6>(12, 12) = isotropic_noise(1.0, 1.0);
  return state;
}

}  // namespace alidade::test
