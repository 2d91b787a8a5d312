// SPDX-License-Identifier: Apache-2.0
#include "marker1d/paper_rotation.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

double cosine_of(const Eigen::Vector3d& P) {
  const double square = P.squaredNorm();
  if (!(square < 1.0)) throw std::invalid_argument(fmt::format("paper rotation: |P|² must be < 1, got {}", square));
  return std::sqrt(1.0 - square);
}

}  // namespace

Eigen::Matrix3d paper_rotation(const Eigen::Vector3d& P) {
  const double c = cosine_of(P);
  return c * Eigen::Matrix3d::Identity() + skew(P) + P * P.transpose() / (1.0 + c);
}

PaperRotation differentiate_paper_rotation(const Eigen::Vector3d& P) {
  using Matrix = Eigen::Matrix3d;
  const Matrix I = Matrix::Identity();
  const double c = cosine_of(P), beta = 1.0 / (1.0 + c);
  const Matrix PP = P * P.transpose();
  const Eigen::Vector3d c_j = -P / c, beta_j = beta * beta / c * P;
  std::array<Matrix, 3> S;
  for (int j = 0; j < 3; ++j) S[j] = Matrix(I.col(j) * P.transpose()) + Matrix(P * I.row(j));

  PaperRotation rotation;
  rotation.A = c * I + skew(P) + beta * PP;
  for (int j = 0; j < 3; ++j) {
    rotation.A_j[j] = c_j(j) * I + skew(I.col(j)) + beta_j(j) * PP + beta * S[j];
    for (int k = 0; k <= j; ++k) {
      const double c_jk = -I(j, k) / c - P(j) * P(k) / (c * c * c);
      const double beta_jk = 2.0 * beta * beta * beta * c_j(j) * c_j(k) - beta * beta * c_jk;
      Matrix A_jk = c_jk * I + beta_jk * PP + beta_j(j) * S[k] + beta_j(k) * S[j];
      A_jk(j, k) += beta;
      A_jk(k, j) += beta;
      rotation.A_jk[j][k] = rotation.A_jk[k][j] = A_jk;
    }
  }
  return rotation;
}

Eigen::Vector3d paper_parameters(const Eigen::Matrix3d& A) {
  return 0.5 * Eigen::Vector3d(A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1));
}

}  // namespace alidade
