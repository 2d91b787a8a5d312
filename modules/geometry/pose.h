// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace alidade {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// T * perturbation(xi) is the pose T moved by xi = (translation in its own axes, rotation vector), in m and rad:
/// the translation is added along T's axes and the rotation applied on the right (SO(3) × R³, not the SE(3) screw).
Eigen::Isometry3d perturbation(const Vector6d& xi);

/// The xi that moves `from` to `to`: to = from * perturbation(difference(from, to)).
Vector6d difference(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

/// The pose at `fraction` of the way from a (0) to b (1): straight line and constant rotation axis; fractions beyond
/// [0, 1] extrapolate.
Eigen::Isometry3d interpolate(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double fraction);

/// Angle of a rotation in rad, [0, π].
double rotation_angle(const Eigen::Matrix3d& R);

}  // namespace alidade
