// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <opencv2/core/mat.hpp>

#include "calib/boards/board.h"
#include "calib/boards/board_view.h"
#include "calib/boards/marker_finder.h"

namespace alidade {

/// The corners of a ChArUco board (between its squares) or of an AprilGrid (four per tag) in a grey image of 8 bits;
/// the board may be seen in part. Each sigma_px follows from the image's noise and the gradients about the corner.
/// Empty where fewer than four corners, or none in a second row or column, are seen. Of an AprilGrid, tags may count
/// from the top left downwards or, as Kalibr prints it, from the bottom left upwards, and have a border of one cell or
/// two; of more than one row and column, tags of two rows and two columns must be seen, as this tells how they count.
/// Throws std::invalid_argument for a chessboard, a board that pattern_of refuses, and another type of image.
std::optional<BoardView> detect_markers_board(const cv::Mat& grey, const Board& board);

/// Which of the two layouts a ChArUco board has, by the places of its markers to each other; empty where the image
/// shows too few of them. `board.layout` is not looked at. Throws as detect_markers_board.
std::optional<CharucoLayout> find_charuco_layout(const cv::Mat& grey, const Board& board);

}  // namespace alidade
