// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <opencv2/core/mat.hpp>

#include "calib/boards/board.h"

namespace alidade {

/// A board that nobody has named.
struct GuessedBoard {
  Board board;
  bool scale_is_assumed = true;  ///< the side of a square or tag is set to 25 mm: images alone do not tell it
};

/// The board that grey images of 8 bits show: its kind, size, layout, dictionary (the smallest that has its markers)
/// and shares of markers and gaps, to a hundredth of a square. Markers are looked for first, in all of OpenCV's
/// dictionaries, then chessboards. Rows and columns that no image shows are not known of. Empty where no board is seen.
/// Throws std::invalid_argument for another type of image.
std::optional<GuessedBoard> guess_board(std::span<const cv::Mat> greys);

}  // namespace alidade
