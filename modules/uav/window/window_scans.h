// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "uav/batch/bearing_rows.h"
#include "uav/window/direction_grid.h"
#include "uav/window/window_association.h"

namespace alidade {

/// What one receiver saw in one period: no two of its bearings are of the same target.
struct WindowScan {
  int receiver = 0;
  double t_s = 0.0;                   ///< mean time of its bearings, from the window's reference
  std::vector<std::size_t> bearings;  ///< their places in the window
  DirectionGrid grid;                 ///< of their directions, by their order here
  double half_time_s = 0.0;           ///< by how much their times differ from t_s at most
  double origin_spread_m = 0.0;       ///< by how much their origins differ from the first one's at most
  double greatest_sigma_rad = 0.0;
};

/// A window of bearings, prepared.
struct BearingWindow {
  WindowOptions options;
  MotionFrame frame;
  std::vector<BearingRows> rows;  ///< of each bearing
  std::vector<double> sigma_rad;  ///< of each bearing, mean of both directions
  std::vector<double> log_gain;   ///< of each bearing: of being a target's and right on it, against being false
  std::vector<std::size_t> scan_of;
  std::vector<WindowScan> scans;  ///< that have bearings, in order of time
  double begin_s = 0.0, end_s = 0.0;
};

/// Throws as associate_window does.
BearingWindow prepare_window(std::span<const Bearing> bearings, const WindowOptions& options);

}  // namespace alidade
