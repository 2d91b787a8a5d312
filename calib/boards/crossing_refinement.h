// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "calib/boards/board_view.h"

namespace alidade {

/// A place where two edges cross, roughly. Other edges lie beyond the lines through pixel + step_x along step_y and
/// through pixel + step_y along step_x, and their mirror images about the pixel.
struct CrossingGuess {
  int id = 0;  ///< of the board's corner
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d step_x = {1, 0}, step_y = {0, 1};  ///< along the two edges, px
  double within_px = 1;                              ///< how far the crossing may be from `pixel`
};

/// Where the edges cross in a grey image of 8 bits, and how well it is known: from the image's noise and the gradients
/// about it. Crossings farther from their guess than said, or within 3 px of the image's border, are left out.
/// Throws std::invalid_argument for another type of image. Source: cv::cornerSubPix in the largest upright window that
/// no other edge enters.
std::vector<BoardCorner> refine_crossings(const cv::Mat& grey, std::span<const CrossingGuess> guesses);

}  // namespace alidade
