// SPDX-License-Identifier: Apache-2.0
#include "estimation/motion_noise.h"

namespace alidade {

Matrix6d isotropic_noise(double linear, double angular) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(linear * linear), Eigen::Vector3d::Constant(angular * angular);
  return variances.asDiagonal();
}

MotionProcess guessed_motion(double v, double omega, double dt) {
  MotionNoise calm, manoeuvre, jolt;
  calm.jerk = isotropic_noise(0.05 * v / (dt * dt), 0.05 * omega / (dt * dt));
  manoeuvre.jump = isotropic_noise(v / dt, omega / dt);
  jolt.jump = 64.0 * manoeuvre.jump;
  return {{calm, 0.94}, {manoeuvre, 0.05}, {jolt, 0.01}};
}

MotionNoise mean_noise(const MotionProcess& motion, std::span<const double> weights) {
  MotionNoise mean;
  for (std::size_t m = 0; m < motion.size(); ++m) {
    mean.acceleration += weights[m] * motion[m].noise.acceleration;
    mean.jerk += weights[m] * motion[m].noise.jerk;
    mean.jump += weights[m] * motion[m].noise.jump;
  }
  return mean;
}

MotionNoise mean_noise(const MotionProcess& motion) {
  std::vector<double> weights;
  for (const MotionMode& mode : motion) weights.push_back(mode.weight);
  return mean_noise(motion, weights);
}

}  // namespace alidade
