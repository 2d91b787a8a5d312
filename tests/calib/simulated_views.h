// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calib/bundle/board_bundle.h"
#include "calib/cameras/lens_model.h"
#include "calib/rigs/rig_calibration.h"

namespace alidade::test {

/// A chessboard of 9x6 inner corners, 25 mm apart.
Board simulated_board();

/// A VGA camera of about 530 px with a cheap lens of this model; the fisheye (250 px) sees 73 degrees off axis.
Camera simulated_camera(LensModel lens);

struct Simulation {
  int views = 10;
  double noise_px = 0;     ///< standard deviation of each coordinate
  double sigma_px = 0.1;   ///< what the corners state
  double most_tilt = 0.6;  ///< rad about either axis of the board; 0: all boards face the camera
  double distance = 2.0;   ///< in lengths at which the board's diagonal is as long as the image is wide, +- 25 %
  BoardWarp warp = {};
};

/// What a camera sees, and where the boards truly stood.
struct SimulatedViews {
  std::vector<BoardView> views;
  std::vector<Eigen::Isometry3d> T_camera_board;
};

/// Boards all corners of which lie in the image, at random places, tilts and distances.
SimulatedViews simulate_views(const Camera& camera, const Simulation& simulation, unsigned seed);

/// The same as a bundle at the truth, all weights 1.
struct SimulatedBundle {
  BoardShape shape;
  BoardBundle truth;
  std::vector<BundleView> views;
};
SimulatedBundle simulate_bundle(const Camera& camera, const Simulation& simulation, unsigned seed);

/// What the cameras of a rig see: at moment i those of `who_looks[i]`, and all of these see the whole board.
struct SimulatedRig {
  std::vector<RigCameraViews> cameras;
  std::vector<Eigen::Isometry3d> T_rig_board;
};
SimulatedRig simulate_rig(const std::vector<BundleCamera>& cameras, const std::vector<std::vector<int>>& who_looks,
                          const Simulation& simulation, unsigned seed);

/// The farthest that two cameras image the same directions from each other, px: those of 9x9 pixels over the image of
/// `truth`, from `border` (a share of it) to the other side.
double largest_difference_px(const Camera& truth, const Camera& found, double border = 0.1);

}  // namespace alidade::test
