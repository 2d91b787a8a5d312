// SPDX-License-Identifier: Apache-2.0
#include "marker1d/motion_learner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/motion_learning.h"

namespace alidade {
namespace {

constexpr int kFirst = 40;          // batches before anything is learned
constexpr std::size_t kMost = 400;  // batches to learn from, from the last lesson on
constexpr int kSeldom = 4000;       // batches between two lessons in the long run
constexpr int kRounds = 2;          // of a search by factors of two

std::vector<MotionStep> filtered(MotionState state, const std::vector<MotionLikelihood>& likelihoods,
                                 const MotionProcess& motion) {
  std::vector<MotionStep> steps;
  for (const MotionLikelihood& z : likelihoods) {
    steps.push_back(absorb(state, z.at.time, motion, z));
    state = steps.back().state;
  }
  return steps;
}

double log_evidence(const std::vector<MotionStep>& steps) {
  double sum = 0.0;
  for (const MotionStep& step : steps) sum += step.log_evidence;
  return sum;
}

// Noise whose standard deviations are `linear` and `angular` times as large.
MotionProcess scaled(MotionProcess motion, double linear, double angular) {
  Vector6d factor;
  factor << Eigen::Vector3d::Constant(linear), Eigen::Vector3d::Constant(angular);
  for (MotionMode& mode : motion) {
    mode.noise.jerk = factor.asDiagonal() * mode.noise.jerk * factor.asDiagonal();
    mode.noise.jump = factor.asDiagonal() * mode.noise.jump * factor.asDiagonal();
  }
  return motion;
}

bool is_finite(const MotionProcess& motion) {
  return std::all_of(motion.begin(), motion.end(), [](const MotionMode& m) {
    return std::isfinite(m.weight) && m.noise.jerk.allFinite() && m.noise.jump.allFinite();
  });
}

}  // namespace

void MotionLearner::start(double dt) {
  // A hand changes its acceleration by some 10 m/s² and 50 rad/s² within 0.1 s: as white noise held over a step, a jerk
  // whose square times the step is 2 a² / 0.1 s.
  const double per_root_dt = std::sqrt(2.0 / 0.1 / dt);
  MotionNoise calm, manoeuvre, jolt;
  calm.jerk = isotropic_noise(10.0 * per_root_dt, 50.0 * per_root_dt);
  manoeuvre.jump = isotropic_noise(20.0, 100.0);
  jolt.jump = 25.0 * manoeuvre.jump;
  motion_ = {{calm, 0.97}, {manoeuvre, 0.02}, {jolt, 0.01}};
  count_ = 0;
  next_ = kFirst;
  interrupt();
}

bool MotionLearner::add(const MotionState& before, MotionLikelihood likelihood) {
  if (recent_.empty()) first_ = before;
  if (recent_.size() < kMost) recent_.push_back(std::move(likelihood));
  if (++count_ < next_) return false;
  const int wait = std::min(kSeldom, static_cast<int>(0.5 * count_));
  next_ = count_ + wait;
  // Expectation and maximisation find the noise's shape, but creep towards its size: that is searched for.
  std::vector<std::vector<MotionStep>> recordings{filtered(first_, recent_, motion_)};
  double reached = log_evidence(recordings.front());
  for (int round = 0; round < kRounds; ++round) {
    for (const auto& [linear, angular] : {std::pair{0.5, 1.0}, {2.0, 1.0}, {1.0, 0.5}, {1.0, 2.0}}) {
      const MotionProcess other = scaled(motion_, linear, angular);
      std::vector<MotionStep> steps = filtered(first_, recent_, other);
      if (const double evidence = log_evidence(steps); evidence > reached) {
        reached = evidence;
        motion_ = other;
        recordings.front() = std::move(steps);
      }
    }
  }
  const MotionProcess better = learned(motion_, recordings);
  if (is_finite(better)) motion_ = better;
  recent_.clear();
  return true;
}

void MotionLearner::interrupt() {
  recent_.clear();
}

}  // namespace alidade
