// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

namespace alidade {

// The paper's rotation by three numbers P = (p, q, r) = axis · sin φ, for angles |φ| < 90°:
//   A = c I + [P]× + β P Pᵀ,   c = √(1 - |P|²), β = 1 / (1 + c).
// Source: marker1d paper page, "Rotation" and "Derivatives".

/// A(P), a rotation matrix. Throws std::invalid_argument where |P| is not below 1.
Eigen::Matrix3d paper_rotation(const Eigen::Vector3d& P);

/// A(P) with its first and second derivatives.
struct PaperRotation {
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  std::array<Eigen::Matrix3d, 3> A_j;                  ///< ∂A/∂P_j
  std::array<std::array<Eigen::Matrix3d, 3>, 3> A_jk;  ///< ∂²A/∂P_j∂P_k
};

/// Throws as paper_rotation does.
PaperRotation differentiate_paper_rotation(const Eigen::Vector3d& P);

/// The P of a rotation by less than 90°, the inverse of paper_rotation; of a wider one, the P of 180° less its angle.
Eigen::Vector3d paper_parameters(const Eigen::Matrix3d& A);

}  // namespace alidade
