// SPDX-License-Identifier: Apache-2.0
#include "estimation/state_smoother.h"

#include <algorithm>

#include <Eigen/Cholesky>

namespace alidade {

std::vector<SmoothedState> smooth(std::span<const MotionStep> steps) {
  std::vector<SmoothedState> result(steps.size());
  if (steps.empty()) return result;
  result.back().state = steps.back().state;
  for (std::size_t i = steps.size() - 1; i-- > 0;) {
    const MotionState& now = steps[i].state;
    const MotionState& predicted = steps[i + 1].predicted;
    const MotionState& next = result[i + 1].state;
    const Matrix18d F = transition_jacobian(now, predicted);
    // P Fᵀ P⁻¹ of the prediction, in units in which it has ones on its diagonal: positions and accelerations differ by
    // orders of magnitude.
    const Vector18d unit = predicted.covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
    const Vector18d per_unit = unit.cwiseInverse();
    const Matrix18d correlation = per_unit.asDiagonal() * predicted.covariance * per_unit.asDiagonal();
    const Matrix18d solved = correlation.ldlt().solve(per_unit.asDiagonal() * F * now.covariance);
    const Matrix18d G = (per_unit.asDiagonal() * solved).transpose();
    result[i].state = moved_by(now, G * error_between(predicted, next));
    result[i].state.covariance = now.covariance + G * (next.covariance - predicted.covariance) * G.transpose();
    result[i].with_next = G * next.covariance;
  }
  return result;
}

std::vector<MotionState> smoothed_states(std::span<const MotionStep> steps, int lag) {
  std::vector<MotionState> states;
  if (lag < 0) {
    for (SmoothedState& s : smooth(steps)) states.push_back(std::move(s.state));
    return states;
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::size_t known = std::min(steps.size() - i, static_cast<std::size_t>(lag) + 1);
    states.push_back(smooth(steps.subspan(i, known)).front().state);
  }
  return states;
}

}  // namespace alidade
