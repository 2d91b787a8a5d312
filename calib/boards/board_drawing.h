// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "calib/boards/board.h"

namespace alidade {

/// A picture of a board, and where its frame lies in it: a point (x, y) m is at pixel origin_px + pixels_per_m (x, y).
struct BoardDrawing {
  cv::Mat image;  ///< CV_8UC1: 0 black, 255 white
  Eigen::Vector2d origin_px = Eigen::Vector2d::Zero();
  double pixels_per_m = 0;
};

/// Draws a board with `margin_m` of white around it. Pixels hold the mean over their area, so that edges are exact at
/// any scale; they are sharp where a square (and a cell of a marker) is a whole number of pixels. Throws
/// std::invalid_argument as pattern_of, for a scale that is not > 0 or a margin that is not >= 0.
BoardDrawing draw_board(const Board& board, double pixels_per_m, double margin_m);

}  // namespace alidade
