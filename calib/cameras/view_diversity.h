// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "calib/bundle/board_bundle.h"

namespace alidade {

/// How far the corners that two views both show lie apart; corners sorted by id.
struct CommonMotion {
  int corners = 0;    ///< that both show
  double rms_px = 0;  ///< root mean square of their distances
};
CommonMotion common_motion(std::span<const BoardCorner> from, std::span<const BoardCorner> to);

/// Which views show the same as an earlier one: for each view the earlier one's index, or -1. Two views are the same
/// where the corners that both show lie within `distance_px` of each other on average (root mean square).
std::vector<int> find_repeated_views(std::span<const BundleView> views, double distance_px);

/// The largest angle (rad) between the normals of two boards as camera `index` sees them: 0 where all face it alike,
/// and nothing tells the focal length from the distance.
double tilt_spread_rad(const BoardBundle& bundle, std::span<const BundleView> views, int index);

}  // namespace alidade
