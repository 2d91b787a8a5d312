// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/time.h"

namespace alidade {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Where a target is at one moment, how it moves, and how sure that is.
struct TargetState {
  Timestamp time{};
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d v_world = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d a_world = Eigen::Vector3d::Zero();  ///< m/s²
  /// Of (p, v, a) in world axes; m, m/s, m/s². Rows and columns of what is not estimated (a of a target that is taken
  /// to fly straight on) are 0.
  Matrix9d covariance = Matrix9d::Zero();
};

/// The state at another time, with its covariance, if the acceleration stays what it is.
TargetState moved_to(const TargetState& state, Timestamp time);

}  // namespace alidade
