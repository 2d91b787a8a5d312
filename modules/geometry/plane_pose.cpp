// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_pose.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "geometry/rotation_descent.h"

namespace alidade {

int determined_directions(const Matrix6d& information, double least_share) {
  Vector6d scale = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (information(i, i) > 0) scale(i) = 1.0 / std::sqrt(information(i, i));
  }
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  // The other five eigenvalues' product is at most 1.2⁵ = 2.5, their mean being 1.2 at most: cheaper than eigenvalues.
  const Eigen::LLT<Matrix6d> factor(scaled);
  if (factor.info() == Eigen::Success) {
    const double root = factor.matrixL().toDenseMatrix().diagonal().prod();
    if (root * root > 2.5 * least_share) return 6;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled, Eigen::EigenvaluesOnly);
  return static_cast<int>((solver.eigenvalues().array() > least_share).count());
}

PlanePose plane_pose_at(std::span<const PlaneConstraint> constraints, const Eigen::Isometry3d& T_world_body) {
  PlanePose result{T_world_body, 0.0, information(sum_planes(constraints), T_world_body)};
  for (const PlaneConstraint& constraint : constraints) {
    const double r = distance(constraint.plane_world, T_world_body * constraint.p_body);
    result.chi2 += constraint.weight * r * r;
  }
  return result;
}

std::optional<Eigen::Isometry3d> newton_pose(const PlaneSums& sums, const Eigen::Isometry3d& start) {
  const RotationCost cost = eliminate_translation(sums);
  if (cost.translation_rank < 3) return std::nullopt;
  const std::optional<Eigen::Matrix3d> R = newton_rotation(cost, start.linear());
  if (!R) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = *R;
  T.translation() = cost.translation(*R);
  return T;
}

}  // namespace alidade
