// SPDX-License-Identifier: Apache-2.0
#include "tracking/recording_noise.h"

#include <algorithm>

#include <Eigen/LU>

#include "estimation/motion_learning.h"
#include "estimation/state_smoother.h"

namespace alidade {
namespace {

bool is_seen(const FrameLikelihood& frame) {
  return !frame.sightings.information.isZero(0.0);
}

// R of the next step: the mean square of what each frame is off by, given the smoothed states.
Matrix6d learned_pose_noise(const Matrix6d& R, std::span<const FrameLikelihood> frames,
                            std::span<const SmoothedState> states) {
  Matrix6d sum = Matrix6d::Zero();
  int count = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (!is_seen(frames[k])) continue;
    const PoseLikelihood z = about(states[k].state.T_world_body, frames[k].sightings);
    const Eigen::PartialPivLU<Matrix6d> blur(Matrix6d::Identity() + z.information * R);
    // E and covariance of the common error o: y = Λ⁻¹g is measured of o + noise, about a state of covariance P.
    const Matrix6d weight = R * blur.solve(z.information);
    const Vector6d mean = R * blur.solve(z.gradient);
    const Matrix6d P = states[k].state.covariance.topLeftCorner<6, 6>();
    sum += mean * mean.transpose() + weight * P * weight.transpose() + R - weight * R;
    ++count;
  }
  return count > 0 ? Matrix6d(0.5 / count * (sum + sum.transpose())) : R;
}

}  // namespace

Matrix6d guessed_pose_noise(const PoseLikelihood& sightings) {
  constexpr double kSigmas = 10.0;
  return kSigmas * kSigmas * sightings.information.inverse();
}

PoseLikelihood blurred(const PoseLikelihood& sightings, const Matrix6d& covariance) {
  const Eigen::PartialPivLU<Matrix6d> blur(Matrix6d::Identity() + sightings.information * covariance);
  PoseLikelihood result = sightings;
  result.information = blur.solve(sightings.information);
  result.information = 0.5 * (result.information + result.information.transpose()).eval();
  result.gradient = blur.solve(sightings.gradient);
  return result;
}

std::vector<MotionStep> filter_recording(const MotionState& first, std::span<const FrameLikelihood> frames,
                                         const RecordingNoise& noise) {
  std::vector<MotionStep> steps;
  for (const FrameLikelihood& frame : frames) {
    const MotionState& state = steps.empty() ? first : steps.back().state;
    steps.push_back(is_seen(frame) ? absorb(state, frame.time, noise.motion, blurred(frame.sightings, noise.pose))
                                   : pass(state, frame.time, noise.motion));
  }
  return steps;
}

RecordingNoise learned(RecordingNoise noise, const MotionState& first, std::span<const FrameLikelihood> frames,
                       int steps) {
  constexpr std::size_t kFewest = 10;
  if (frames.size() < kFewest) return noise;
  if (noise.pose.isZero(0.0)) {
    const auto seen = std::find_if(frames.begin(), frames.end(), is_seen);
    if (seen == frames.end()) return noise;
    noise.pose = guessed_pose_noise(seen->sightings);
  }
  for (int i = 0; i < steps; ++i) {
    const std::vector<std::vector<MotionStep>> recording{filter_recording(first, frames, noise)};
    const std::vector<SmoothedState> states = smooth(recording.front());
    noise = {learned(noise.motion, recording), learned_pose_noise(noise.pose, frames, states)};
  }
  return noise;
}

}  // namespace alidade
