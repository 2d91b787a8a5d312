// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace alidade {

/// A corner of a board in an image.
struct BoardCorner {
  int id = 0;                                       ///< index into corners_m(board)
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< px
  double sigma_px = 0.1;                            ///< standard deviation of each coordinate, as the detector knows it
};

/// What one image shows of the board; sorted by id, no id twice.
struct BoardView {
  std::string name;  ///< of the image
  int frame = 0;     ///< which of the images, in their order; of a rig: which moment
  double time_s = 0;
  std::vector<BoardCorner> corners;
};

}  // namespace alidade
