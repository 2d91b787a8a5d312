// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/positions.h"

namespace alidade {

/// Where something was at a moment, and how fast it went there.
struct TrackPoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d v_world = Eigen::Vector3d::Zero();  ///< m/s
};

/// A known path between its positions: cubic, through the positions, with the slope of each one's neighbours (Catmull
/// and Rom). At 5 Hz straight lines would be off by the third part of a decimetre in a brisk turn.
class KnownTrack {
 public:
  /// Throws std::invalid_argument for fewer than four positions, and times that do not increase.
  explicit KnownTrack(std::vector<TimedPosition> positions);

  /// Empty before the second position and after the last but one, and where neighbours are more than `longest_gap_s`
  /// apart.
  std::optional<TrackPoint> at(double t_s, double longest_gap_s = 1.0) const;

  double begin_s() const { return times_s_[1]; }
  double end_s() const { return times_s_[times_s_.size() - 2]; }

 private:
  std::vector<double> times_s_;
  std::vector<Eigen::Vector3d> positions_;
};

}  // namespace alidade
