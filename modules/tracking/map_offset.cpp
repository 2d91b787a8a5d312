// SPDX-License-Identifier: Apache-2.0
#include "tracking/map_offset.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "geometry/rotation.h"

namespace alidade {
namespace {

// How a point moves with the offset.
Eigen::Matrix<double, 3, 6> jacobian(const MapOffset& offset, const Eigen::Vector3d& p_world) {
  Eigen::Matrix<double, 3, 6> J;
  J << Eigen::Matrix3d::Identity(), -skew(p_world - offset.centre_world);
  return J;
}

}  // namespace

MapOffset rigid_offset(std::span<const PointObservation> observations) {
  MapOffset offset;
  if (observations.size() < 3) return offset;
  for (const PointObservation& o : observations) offset.centre_world += o.p_world;
  offset.centre_world /= static_cast<double>(observations.size());
  Matrix6d information = Matrix6d::Zero();
  for (const PointObservation& o : observations) {
    const Eigen::LLT<Eigen::Matrix3d> factor(o.covariance_world);
    if (factor.info() != Eigen::Success) return offset;
    const Eigen::Matrix<double, 3, 6> J = jacobian(offset, o.p_world);
    information += J.transpose() * factor.solve(J);
  }
  // Metres and radians brought to one measure, so that the least eigenvalue tells whether anything is left open.
  const Vector6d unit = information.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix6d scaled = unit.asDiagonal() * information * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled);
  if (solver.eigenvalues()(0) > 1e-9) offset.covariance = information.inverse();
  return offset;
}

std::vector<PointObservation> apart_from(const MapOffset& offset, std::vector<PointObservation> observations) {
  for (PointObservation& o : observations) {
    const Eigen::Matrix<double, 3, 6> J = jacobian(offset, o.p_world);
    o.covariance_world -= J * offset.covariance * J.transpose();
  }
  return observations;
}

}  // namespace alidade
