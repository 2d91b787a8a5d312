// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "tracking/map_search.h"
#include "tracking/slam_filter.h"

namespace alidade {

/// A filter with points of a map in its own state, where they stay as they entered and as its own updates move them.
struct SlamTrack {
  SlamState state;
  std::vector<int> map_points;  ///< which point of the map each of the state's is
};

/// A frame for it.
struct SlamFrame {
  Timestamp time{};
  MotionNoise noise;                ///< since the frame before
  std::vector<FoundPoint> inliers;  ///< of the map
  double sigma_px = 1.0;
};

/// The filter after a frame. Points enter when they are first seen, with the map's covariance and nothing in common
/// with the state; there are at most `most_points`. Those that `living` (ascending indices) no longer holds leave, and
/// those that the frame does not see where others need their place.
SlamTrack follow(const Camera& camera, const SlamTrack& track, const PointMap& map, std::span<const int> living,
                 const SlamFrame& frame, int most_points);

}  // namespace alidade
