// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "calib/boards/board_view.h"

namespace alidade {

/// A place where two edges cross, roughly, on a plane that holds more than these edges. Pixels at
/// pixel + u step_x + v step_y with |u|, |v| < 1 and one of them < band show nothing else.
struct CrossingGuess {
  int id = 0;  ///< of the board's corner
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d step_x = {1, 0}, step_y = {0, 1};  ///< along the two edges, px
  double band = 1;
  double within_px = 1;  ///< how far the crossing may be from `pixel`
};

/// Where the edges cross in a grey image of 8 bits, with the fit's sigma_px. Crossings farther from their guess than
/// said, or within 3 px of the image's border, are left out. Throws std::invalid_argument for another type of image.
/// Source: fit_edge_crossing; where that fails, cv::cornerSubPix, at 0.3 px.
std::vector<BoardCorner> refine_crossings(const cv::Mat& grey, std::span<const CrossingGuess> guesses);

}  // namespace alidade
