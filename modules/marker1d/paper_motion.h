// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "core/time.h"

namespace alidade {

/// The last poses of a body, and what follows from them at another time with velocity and acceleration kept: the
/// parabola through them by least squares, of two poses the line, of one the pose itself. Times may fall as well as
/// rise; a pose at the time of the last one takes its place.
class PaperMotion {
 public:
  /// `memory`: how many poses are kept, at least 1.
  explicit PaperMotion(int memory) : memory_(static_cast<std::size_t>(memory)) {}

  bool is_empty() const { return past_.empty(); }
  void add(Timestamp time, const Eigen::Isometry3d& T_world_body);
  void clear() { past_.clear(); }

  /// Throw std::invalid_argument while there is no pose.
  Eigen::Isometry3d pose_at(Timestamp time) const;
  Eigen::Vector3d point_at(Timestamp time, const Eigen::Vector3d& p_body) const;

 private:
  struct Past {
    Timestamp time{};
    Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  };

  Eigen::VectorXd weights_at(Timestamp time) const;

  std::size_t memory_;
  std::vector<Past> past_;  // the last one last
};

}  // namespace alidade
