// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "uav/batch/bearing_rows.h"
#include "uav/batch/motion_fit.h"

namespace alidade {

/// x = (p, v) for N = 6 or (p, v, a) for N = 9, of the moment and from the anchor that a MotionFrame names.
template <int N>
using MotionVector = Eigen::Matrix<double, N, 1>;
template <int N>
using MotionMatrix = Eigen::Matrix<double, N, N>;

/// Where a motion is at `t_s` (m, from the anchor).
template <int N>
Eigen::Vector3d position_of(const MotionVector<N>& x, double t_s) {
  Eigen::Vector3d p = x.template head<3>() + t_s * x.template segment<3>(3);
  if constexpr (N == 9) p += 0.5 * t_s * t_s * x.template tail<3>();
  return p;
}

/// Zero information: nothing is known beforehand.
template <int N>
struct MotionPrior {
  MotionMatrix<N> information = MotionMatrix<N>::Zero();
  MotionVector<N> mean = MotionVector<N>::Zero();
  bool is_empty = true;
};

template <int N>
struct MotionSolution {
  MotionOutcome outcome = MotionOutcome::TooFew;
  MotionVector<N> x = MotionVector<N>::Zero();               ///< what was come to, whatever the outcome
  MotionMatrix<N> covariance = MotionMatrix<N>::Identity();  ///< where determined
  double chi2 = 0.0;
};

/// fit_motion on prepared bearings. Allocates nothing.
template <int N>
MotionSolution<N> solve_motion(std::span<const BearingRows> rows, const MotionPrior<N>& prior,
                               const MotionFitOptions& options);

/// Gauss–Newton from `start` alone, where that is near: a hypothesis that gained a bearing.
template <int N>
MotionSolution<N> refine_motion(std::span<const BearingRows> rows, const MotionPrior<N>& prior,
                                const MotionFitOptions& options, const MotionVector<N>& start);

}  // namespace alidade
