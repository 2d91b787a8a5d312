// SPDX-License-Identifier: Apache-2.0
#include "estimation/motion_learning.h"

#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "estimation/state_smoother.h"

namespace alidade {
namespace {

Vector6d accelerations(const MotionState& state) {
  Vector6d a;
  a << state.a_world, state.alpha_body;
  return a;
}

// Covariance of what a step's noise changes the accelerations by.
Matrix6d of_change(const MotionNoise& noise, double dt) {
  return dt * dt * noise.jerk + noise.jump;
}

// information - part, which is semidefinite but for rounding: what is left may be a tiny share of either.
Matrix6d without(const Matrix6d& part, const Matrix6d& information) {
  const Eigen::LLT<Matrix6d> root(information);
  const Matrix6d half = root.matrixL().solve(part);
  const Matrix6d share = root.matrixL().solve(half.transpose());
  Eigen::SelfAdjointEigenSolver<Matrix6d> axes(Matrix6d::Identity() - 0.5 * (share + share.transpose()));
  const Matrix6d left =
      axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).asDiagonal() * axes.eigenvectors().transpose();
  return root.matrixL() * left * root.matrixU();
}

}  // namespace

MotionProcess learned(const MotionProcess& motion, std::span<const std::vector<MotionStep>> recordings) {
  std::vector<Matrix6d> jerk(motion.size(), Matrix6d::Zero()), jump = jerk;
  std::vector<double> weight(motion.size(), 0.0);
  int count = 0;
  for (const std::vector<MotionStep>& steps : recordings) {
    const std::vector<SmoothedState> smoothed = smooth(steps);
    for (std::size_t i = 0; i + 1 < smoothed.size(); ++i) {
      const double dt = to_seconds(smoothed[i + 1].state.time - smoothed[i].state.time);
      if (!(dt > 0)) continue;
      const Vector6d change = accelerations(smoothed[i + 1].state) - accelerations(smoothed[i].state);
      const Matrix6d shared = smoothed[i].with_next.bottomRightCorner<6, 6>();
      const Matrix6d P = smoothed[i].state.covariance.bottomRightCorner<6, 6>() +
                         smoothed[i + 1].state.covariance.bottomRightCorner<6, 6>() - shared - shared.transpose();
      // What all of the recording says of the change but for the step's own noise, which was taken as a mean of the
      // modes': each mode's belief of the change is that with its own noise.
      const Matrix6d information = P.inverse();
      const Matrix6d of_others =
          without(of_change(mean_noise(motion, steps[i + 1].mode_weight), dt).inverse(), information);
      for (std::size_t m = 0; m < motion.size(); ++m) {
        const double probability = steps[i + 1].mode_weight[m];
        weight[m] += probability;
        const Matrix6d Q = of_change(motion[m].noise, dt);
        if (Q.isZero(0.0)) continue;
        const Matrix6d P_mode = (of_others + Q.inverse()).inverse();
        const Vector6d change_mode = P_mode * information * change;
        const Matrix6d square = probability * (change_mode * change_mode.transpose() + P_mode);
        jump[m] += square;
        jerk[m] += square / (dt * dt);
      }
      ++count;
    }
  }
  MotionProcess better = motion;
  if (count < 10) return better;
  // A tenth of an observation of each mode beforehand: none ever becomes impossible, or exact.
  constexpr double kBefore = 0.1;
  for (std::size_t m = 0; m < motion.size(); ++m) {
    const auto blended = [&](const Matrix6d& before, const Matrix6d& sum) {
      return before.isZero(0.0) ? before : Matrix6d((kBefore * before + sum) / (kBefore + weight[m]));
    };
    better[m].noise.jerk = blended(motion[m].noise.jerk, jerk[m]);
    better[m].noise.jump = blended(motion[m].noise.jump, jump[m]);
    better[m].weight = (weight[m] + kBefore) / (count + kBefore * static_cast<double>(motion.size()));
  }
  return better;
}

MotionProcess learn_motion(MotionProcess motion, int most_steps,
                           const std::function<std::vector<std::vector<MotionStep>>(const MotionProcess&)>& filter) {
  constexpr double kLeastGain = 2.0;
  constexpr int kPatience = 2;
  MotionProcess best = motion;
  double reached = -std::numeric_limits<double>::infinity();
  for (int step = 0, without_gain = 0; step < most_steps && without_gain < kPatience; ++step) {
    const std::vector<std::vector<MotionStep>> recordings = filter(motion);
    double evidence = 0.0;
    for (const auto& steps : recordings) {
      for (const MotionStep& s : steps) evidence += s.log_evidence;
    }
    without_gain = evidence - reached < kLeastGain ? without_gain + 1 : 0;
    if (evidence > reached) {
      reached = evidence;
      best = motion;
    }
    motion = learned(motion, recordings);
  }
  return best;
}

}  // namespace alidade
