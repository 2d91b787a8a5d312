// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <opencv2/core/mat.hpp>

#include "calib/boards/board.h"
#include "calib/boards/board_view.h"
#include "calib/boards/corner_refinement.h"

namespace alidade {

/// All corners of a chessboard in a grey image of 8 bits, each to a few hundredths of a pixel; name, frame and time are
/// left to the caller. Empty where the board is not seen as a whole. Which end of the board is corner 0, and what
/// happens to mirrored images: see ChessboardGrid. Throws std::invalid_argument for another kind of board, an
/// impossible one, or another type of image.
std::optional<BoardView> detect_chessboard(const cv::Mat& grey, const Board& board,
                                           const CornerRefinementOptions& options = {});

}  // namespace alidade
