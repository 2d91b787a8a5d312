// SPDX-License-Identifier: Apache-2.0
#include "estimation/motion_likelihood.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "geometry/rotation.h"

namespace alidade {
namespace {

// Whether the measurements speak of the pose alone, as those of one moment do.
bool is_of_pose(const MotionLikelihood& likelihood) {
  return likelihood.information.bottomRightCorner<12, 12>().isZero(0.0);
}

// gᵀ (I + P Λ)⁻¹ P g and ln |I + P Λ|.
template <int N>
double log_evidence(const Eigen::Matrix<double, N, N>& P, const Eigen::Matrix<double, N, N>& information,
                    const Eigen::Matrix<double, N, 1>& gradient) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::PartialPivLU<Square> M(Square::Identity() + P * information);
  return 0.5 * gradient.dot(M.solve(P * gradient)) - 0.5 * std::log(std::abs(M.determinant()));
}

}  // namespace

Matrix18d reset_jacobian(const Vector18d& e) {
  Matrix18d J = Matrix18d::Identity();
  J.topLeftCorner<3, 3>() = exp_so3(-e.segment<3>(3));
  J.block<3, 3>(3, 3) = right_jacobian_so3(e.segment<3>(3));
  return J;
}

Matrix18d covariance_root(const Matrix18d& covariance) {
  const Vector18d unit = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Vector18d per_unit = unit.cwiseInverse();
  constexpr double kRounding = 1e-13;  // keeps the root of a singular one real
  const Matrix18d correlation =
      per_unit.asDiagonal() * covariance * per_unit.asDiagonal() + kRounding * Matrix18d::Identity();
  return unit.asDiagonal() * Matrix18d(correlation.llt().matrixL());
}

MotionLikelihood about(const MotionState& state, const MotionLikelihood& likelihood) {
  const Vector18d off = error_between(state, likelihood.at);
  const Matrix18d J = reset_jacobian(off);
  MotionLikelihood moved;
  moved.at = state;
  moved.information = J.transpose() * likelihood.information * J;
  moved.gradient = J.transpose() * likelihood.gradient + moved.information * off;
  moved.log_density = likelihood.log_density - moved.gradient.dot(off) + 0.5 * off.dot(moved.information * off);
  return moved;
}

MotionState absorb(const MotionState& predicted, const MotionLikelihood& likelihood) {
  const MotionLikelihood z = about(predicted, likelihood);
  const Matrix18d L = covariance_root(predicted.covariance);
  const Matrix18d A = Matrix18d::Identity() + L.transpose() * z.information * L;
  const Eigen::LLT<Matrix18d> factor(A);
  const Vector18d error = L * factor.solve(L.transpose() * z.gradient);
  const Matrix18d root = (factor.matrixL().solve((reset_jacobian(error) * L).transpose())).transpose();
  MotionState state = moved_by(predicted, error);
  state.covariance = root * root.transpose();
  return state;
}

double log_evidence(const Matrix18d& covariance, const MotionLikelihood& about_prediction) {
  if (!is_of_pose(about_prediction)) {
    return about_prediction.log_density +
           log_evidence<18>(covariance, about_prediction.information, about_prediction.gradient);
  }
  return about_prediction.log_density + log_evidence<6>(covariance.topLeftCorner<6, 6>(),
                                                        about_prediction.information.topLeftCorner<6, 6>(),
                                                        about_prediction.gradient.head<6>());
}

}  // namespace alidade
