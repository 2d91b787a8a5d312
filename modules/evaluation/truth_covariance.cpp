// SPDX-License-Identifier: Apache-2.0
#include "evaluation/truth_covariance.h"

#include <Eigen/Eigenvalues>

namespace alidade {
namespace {

// In units in which `scale` has ones on its diagonal: metres and radians are not to be mixed.
Matrix6d without_negative_part(const Matrix6d& difference, const Matrix6d& scale) {
  const Vector6d unit = scale.diagonal().cwiseSqrt().cwiseMax(1e-12);
  const Eigen::DiagonalMatrix<double, 6> to = unit.cwiseInverse().asDiagonal(), back = unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(to * difference * to);
  const Vector6d kept = solver.eigenvalues().cwiseMax(0.0);
  return back * (solver.eigenvectors() * kept.asDiagonal() * solver.eigenvectors().transpose()) * back;
}

}  // namespace

std::optional<Matrix6d> truth_covariance(std::span<const MotionResidual> residuals) {
  constexpr std::size_t kFewest = 7;
  if (residuals.size() < kFewest) return std::nullopt;
  Matrix6d observed = Matrix6d::Zero(), measured = Matrix6d::Zero();
  const double weight = 1.0 / static_cast<double>(residuals.size());
  for (const MotionResidual& r : residuals) {
    observed += weight * r.xi * r.xi.transpose();
    measured += weight * r.covariance;
  }
  return without_negative_part(0.5 * (observed - measured), observed);
}

}  // namespace alidade
