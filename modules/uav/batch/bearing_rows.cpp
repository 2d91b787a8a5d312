// SPDX-License-Identifier: Apache-2.0
#include "uav/batch/bearing_rows.h"

#include <cmath>
#include <stdexcept>

#include "geometry/tangent.h"

namespace alidade {
namespace {

constexpr double kUnitTolerance = 1e-6;

// The inverse of the covariance's lower Cholesky factor.
Eigen::Matrix2d whitening(const Eigen::Matrix2d& covariance) {
  const double l00 = std::sqrt(covariance(0, 0));
  const double l10 = covariance(1, 0) / l00;
  const double l11 = std::sqrt(covariance(1, 1) - l10 * l10);
  if (!(l00 > 0.0) || !(l11 > 0.0) || !std::isfinite(l00 + l11)) {
    throw std::invalid_argument("a bearing's covariance is not positive definite");
  }
  Eigen::Matrix2d W;
  W << 1.0 / l00, 0.0, -l10 / (l00 * l11), 1.0 / l11;
  return W;
}

}  // namespace

MotionFrame frame_of(std::span<const Bearing> bearings) {
  if (bearings.empty()) throw std::invalid_argument("there are no bearings");
  const Timestamp first = bearings.front().time;
  double sum_s = 0.0;
  for (const Bearing& bearing : bearings) sum_s += to_seconds(bearing.time - first);
  return {first + from_seconds(sum_s / static_cast<double>(bearings.size())), bearings.front().origin_world};
}

BearingRows rows_of(const Bearing& bearing, const MotionFrame& frame) {
  if (!(std::abs(bearing.direction_world.norm() - 1.0) <= kUnitTolerance)) {
    throw std::invalid_argument("a bearing's direction is not of unit length");
  }
  if (!bearing.origin_world.allFinite()) throw std::invalid_argument("a bearing's origin is not finite");
  BearingRows rows;
  rows.t_s = to_seconds(bearing.time - frame.reference);
  rows.origin = bearing.origin_world - frame.anchor_world;
  rows.direction = bearing.direction_world;
  rows.whitened = whitening(bearing.covariance) * tangent_basis(bearing.direction_world).transpose();
  return rows;
}

std::vector<BearingRows> rows_of(std::span<const Bearing> bearings, const MotionFrame& frame) {
  std::vector<BearingRows> rows;
  rows.reserve(bearings.size());
  for (const Bearing& bearing : bearings) rows.push_back(rows_of(bearing, frame));
  return rows;
}

}  // namespace alidade
