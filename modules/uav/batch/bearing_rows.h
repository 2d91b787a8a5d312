// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "camera/measurement.h"

namespace alidade {

/// A bearing as two equations of a point: whitened · (p − origin) = 0, each of unit noise times the point's range.
struct BearingRows {
  double t_s = 0.0;                                  ///< since the reference
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m, from the anchor
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  Eigen::Matrix<double, 2, 3> whitened = Eigen::Matrix<double, 2, 3>::Zero();  ///< 1/rad
};

/// Where numbers count from, so that they keep their digits.
struct MotionFrame {
  Timestamp reference{};
  Eigen::Vector3d anchor_world = Eigen::Vector3d::Zero();
};

/// The bearings' mean time and first origin. Throws std::invalid_argument where there are none.
MotionFrame frame_of(std::span<const Bearing> bearings);

/// Throws std::invalid_argument for a direction that is not of unit length, a covariance that is not positive definite,
/// or a value that is not finite.
BearingRows rows_of(const Bearing& bearing, const MotionFrame& frame);
std::vector<BearingRows> rows_of(std::span<const Bearing> bearings, const MotionFrame& frame);

/// How far a bearing is off a point, in sigma, and how that moves with the point.
struct BearingError {
  Eigen::Vector2d error = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 3> J = Eigen::Matrix<double, 2, 3>::Zero();  ///< per m
  double depth_m = 0.0;  ///< of the point along the line of sight; where it is not > 0 the rest means nothing
};

/// `p` (m) from the anchor.
inline BearingError bearing_error(const BearingRows& rows, const Eigen::Vector3d& p) {
  BearingError result;
  const Eigen::Vector3d d = p - rows.origin;
  result.depth_m = rows.direction.dot(d);
  const double inverse = 1.0 / result.depth_m;
  result.error = inverse * (rows.whitened * d);
  result.J = inverse * (rows.whitened - result.error * rows.direction.transpose());
  return result;
}

}  // namespace alidade
