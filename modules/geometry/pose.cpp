// SPDX-License-Identifier: Apache-2.0
#include "geometry/pose.h"

#include "geometry/rotation.h"

namespace alidade {

Eigen::Isometry3d perturbation(const Vector6d& xi) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3(xi.tail<3>());
  T.translation() = xi.head<3>();
  return T;
}

Vector6d difference(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const Eigen::Isometry3d T_from_to = from.inverse() * to;
  Vector6d xi;
  xi << T_from_to.translation(), log_so3(T_from_to.linear());
  return xi;
}

Eigen::Isometry3d interpolate(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double fraction) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = a.linear() * exp_so3(fraction * log_so3(a.linear().transpose() * b.linear()));
  T.translation() = (1.0 - fraction) * a.translation() + fraction * b.translation();
  return T;
}

double rotation_angle(const Eigen::Matrix3d& R) {
  return log_so3(R).norm();
}

}  // namespace alidade
