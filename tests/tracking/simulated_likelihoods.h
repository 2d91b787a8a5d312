// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "tests/tracking/simulated_motion.h"
#include "tracking/recording_noise.h"

namespace alidade::test {

/// A camera that sways and turns gently, and what its frames say of its pose: each claims 0.2 mm and 0.2 mrad, but is
/// off by an error of covariance `common` as well.
struct SimulatedLikelihoods {
  std::vector<StampedPose> truth;
  std::vector<FrameLikelihood> frames;
};

SimulatedLikelihoods simulated_likelihoods(int count, const Matrix6d& common, RandomGeometry& random);

/// Where such a camera begins, as good as unknown.
MotionState before_likelihoods(const SimulatedLikelihoods& simulated);

/// Root mean square distance of poses from the truth, m.
template <typename Poses>
double position_rmse(const Poses& poses, const std::vector<StampedPose>& truth) {
  double sum = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    sum += (poses[k].translation() - truth[k].T_world_camera.translation()).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

}  // namespace alidade::test
