// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/pose.h"

namespace alidade {

/// Gauss–Newton's system of whitened, weighted sightings for the right perturbation of a pose, m and rad.
struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double chi2 = 0.0;
};

/// From the sum of wᵢ rᵢ rᵢᵀ, where r holds ∂pixel/∂xi and the residual beside it; its lower triangle is read.
inline NormalEquations normal_equations(const Eigen::Matrix<double, 7, 7>& sum) {
  NormalEquations equations;
  equations.information = sum.topLeftCorner<6, 6>().selfadjointView<Eigen::Lower>();
  equations.gradient = sum.bottomLeftCorner<1, 6>().transpose();
  equations.chi2 = sum(6, 6);
  return equations;
}

}  // namespace alidade
