// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <opencv2/core/mat.hpp>

#include "calib/boards/board.h"
#include "calib/boards/board_view.h"

namespace alidade {

/// The corners of a board of any kind in an image of 8 bits, grey or BGR; name, frame and time are left to the caller.
/// Empty where the board is not seen: a chessboard as a whole, the others in part. Throws std::invalid_argument for an
/// impossible board or another type of image. Source: detect_chessboard, detect_markers_board.
std::optional<BoardView> detect_board(const cv::Mat& image, const Board& board);

}  // namespace alidade
