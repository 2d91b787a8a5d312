// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "calib/boards/board_view.h"

namespace alidade {

struct CornerRefinementOptions {
  /// Of the window, in squares. On the recordings 0.3 and 0.4 serve equally well; from 0.6 on the window holds edges
  /// that the lens has bent away from where they cross, and the residuals grow by a tenth.
  double half_width = 0.4;
  /// Of the window on large squares, unless it then holds fewer than six blurs: from here on pixels cost time only.
  double most_half_width_px = 12;
  double least_sigma_px = 0.02;  ///< what a corner claims at best: print and glass are no better
  double unfitted_sigma_px =
      0.3;  ///< of corners where the fit fails, or claims no better, and the gradients' word stands
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const CornerRefinementOptions& options);

/// Corners of a chessboard's lattice, `columns` to a row (corner `id` lies in row id / columns), moved to where their
/// edges cross in a grey image of 8 bits. They may start a tenth of a square off. Some may be missing; one without a
/// neighbour in its row or in its column is left out of the result, which keeps their order. Each sigma_px is that of
/// the fit: residual noise times inverse information. Throws std::invalid_argument for another type of image or
/// columns < 1. Source: fit_edge_crossing; cv::cornerSubPix with as wide a window where that fails.
std::vector<BoardCorner> refine_corners(const cv::Mat& grey, std::span<const BoardCorner> corners, int columns,
                                        const CornerRefinementOptions& options = {});

}  // namespace alidade
