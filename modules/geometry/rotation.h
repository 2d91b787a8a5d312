// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace alidade {

/// The skew-symmetric matrix of v: skew(v) * w = v × w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Rotation matrix of the rotation vector phi (rad); exact to machine precision at all angles (Rodrigues).
Eigen::Matrix3d exp_so3(const Eigen::Vector3d& phi);

/// Rotation vector (rad, norm in [0, π]) of R; the inverse of exp_so3, without loss at small angles or near π.
/// R must be a rotation (not checked).
Eigen::Vector3d log_so3(const Eigen::Matrix3d& R);

/// Right Jacobian of SO(3): exp(phi + d) ≈ exp(phi) exp(J d) for small d.
/// Source: Solà, Deray, Atchuthan, A micro Lie theory, eq. 143.
Eigen::Matrix3d right_jacobian_so3(const Eigen::Vector3d& phi);

}  // namespace alidade
