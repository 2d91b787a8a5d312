// SPDX-License-Identifier: Apache-2.0
#include "uav/batch/motion_bound.h"

#include <stdexcept>

#include <Eigen/Cholesky>

#include "uav/batch/bearing_rows.h"

namespace alidade {
namespace {

constexpr double kLeastPivot = 1e-12;  // of the information scaled to a diagonal of 1

template <int N>
std::optional<Matrix9d> inverse_of(const Matrix9d& information) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::Matrix<double, N, 1> diagonal = information.diagonal().head<N>();
  if (!(diagonal.minCoeff() > 0.0)) return std::nullopt;
  const Eigen::Matrix<double, N, 1> scale = diagonal.cwiseSqrt().cwiseInverse();
  const Square scaled = scale.asDiagonal() * information.topLeftCorner<N, N>() * scale.asDiagonal();
  const Eigen::LLT<Square> llt(scaled);
  if (llt.info() != Eigen::Success || llt.matrixLLT().diagonal().array().square().minCoeff() < kLeastPivot) {
    return std::nullopt;
  }
  const Square inverse = llt.solve(Square::Identity());
  Matrix9d covariance = Matrix9d::Zero();
  covariance.topLeftCorner<N, N>() = scale.asDiagonal() * inverse * scale.asDiagonal();
  return covariance;
}

}  // namespace

Matrix9d motion_information(const TargetState& truth, std::span<const Bearing> bearings) {
  Matrix9d information = Matrix9d::Zero();
  for (Bearing bearing : bearings) {
    const double t = to_seconds(bearing.time - truth.time);
    const Eigen::Vector3d p_world = truth.p_world + t * truth.v_world + 0.5 * t * t * truth.a_world;
    const double range = (p_world - bearing.origin_world).norm();
    if (!(range > 0.0)) throw std::invalid_argument("a target is at a receiver's place");
    bearing.direction_world = (p_world - bearing.origin_world) / range;
    const BearingRows rows = rows_of(bearing, {truth.time, bearing.origin_world});
    const Eigen::Matrix3d of_point = rows.whitened.transpose() * rows.whitened / (range * range);
    const double power[] = {1.0, t, 0.5 * t * t};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) information.block<3, 3>(3 * i, 3 * j) += power[i] * power[j] * of_point;
    }
  }
  return information;
}

std::optional<Matrix9d> motion_bound(const TargetState& truth, std::span<const Bearing> bearings, MotionModel model) {
  const Matrix9d information = motion_information(truth, bearings);
  return model == MotionModel::Velocity ? inverse_of<6>(information) : inverse_of<9>(information);
}

}  // namespace alidade
