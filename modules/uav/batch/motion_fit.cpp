// SPDX-License-Identifier: Apache-2.0
#include "uav/batch/motion_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "uav/batch/motion_solver.h"

namespace alidade {
namespace {

template <int N>
MotionPrior<N> prior_in(const MotionFrame& frame, const std::optional<TargetState>& known) {
  if (!known) return {};
  const TargetState there = moved_to(*known, frame.reference);
  MotionPrior<N> prior;
  prior.is_empty = false;
  Vector9d x;
  x << there.p_world - frame.anchor_world, there.v_world, there.a_world;
  prior.mean = x.head<N>();
  const Eigen::LLT<MotionMatrix<N>> llt(there.covariance.topLeftCorner<N, N>());
  if (llt.info() != Eigen::Success || !prior.mean.allFinite()) {
    throw std::invalid_argument("the prior's covariance is not positive definite");
  }
  prior.information = llt.solve(MotionMatrix<N>::Identity());
  return prior;
}

template <int N>
TargetState state_of(const MotionFrame& frame, const MotionSolution<N>& solution) {
  TargetState state;
  state.time = frame.reference;
  state.p_world = frame.anchor_world + solution.x.template head<3>();
  state.v_world = solution.x.template segment<3>(3);
  if constexpr (N == 9) state.a_world = solution.x.template tail<3>();
  state.covariance.topLeftCorner<N, N>() = solution.covariance;
  return state;
}

template <int N>
MotionAnswer fit(std::span<const Bearing> bearings, const MotionFitOptions& options) {
  const MotionFrame frame = frame_of(bearings);
  const std::vector<BearingRows> rows = rows_of(bearings, frame);
  const MotionPrior<N> prior = prior_in<N>(frame, options.prior);
  const MotionSolution<N> solution = solve_motion<N>(rows, prior, options);
  if (solution.outcome != MotionOutcome::Determined) return {solution.outcome, std::nullopt};
  const auto last = std::max_element(bearings.begin(), bearings.end(),
                                     [](const Bearing& a, const Bearing& b) { return a.time < b.time; });
  MotionFit result;
  result.state = moved_to(state_of<N>(frame, solution), options.time.value_or(last->time));
  result.chi2 = solution.chi2;
  result.degrees = 2 * static_cast<int>(bearings.size()) - (prior.is_empty ? N : 0);
  return {MotionOutcome::Determined, result};
}

}  // namespace

void validate(const MotionFitOptions& o) {
  if (!(o.robust_scale >= 0.0)) {
    throw std::invalid_argument(fmt::format("robust_scale must be >= 0 sigma, got {}", o.robust_scale));
  }
  if (!(o.greatest_range_sigma > 0.0)) {
    throw std::invalid_argument(fmt::format("greatest_range_sigma must be > 0, got {}", o.greatest_range_sigma));
  }
}

MotionAnswer fit_motion(std::span<const Bearing> bearings, const MotionFitOptions& options) {
  validate(options);
  if (bearings.empty()) return {};
  return options.model == MotionModel::Velocity ? fit<6>(bearings, options) : fit<9>(bearings, options);
}

}  // namespace alidade
