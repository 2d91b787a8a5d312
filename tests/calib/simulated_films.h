// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/boards/board.h"
#include "calib/clocks/board_film.h"
#include "calib/clocks/clock_refinement.h"

namespace alidade::test {

/// A chessboard of 6x5 inner corners, 40 mm apart: films of it are quick to work on.
Board filmed_chessboard();

/// How a hand moves the board about `distance_m` before the rig's origin: three sines per axis, drawn from a seed.
class HandMotion {
 public:
  /// `size` scales all motion; 0: the board rests.
  HandMotion(unsigned seed, double size = 1.0);
  Eigen::Isometry3d T_rig_board(double rig_time_s) const;

 private:
  Eigen::Matrix<double, 6, 3> amplitude_, frequency_rad_s_, phase_;
};

struct SimulatedFilm {
  double start_s = 0, duration_s = 12;  ///< in the rig's clock
  double rate_hz = 30;
  double offset_s = 0;  ///< added to the camera's times it gives the rig's
  double noise_px = 0.1;
};

/// What the camera sees; corners out of the image are left out, views with fewer than half of them too.
CameraFilm simulate_film(const BundleCamera& camera, const HandMotion& motion, const SimulatedFilm& film,
                         unsigned seed);

/// Two cameras 0.3 m apart, the second one turned to the first one's view.
std::vector<BundleCamera> filming_cameras();

}  // namespace alidade::test
