// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "calib/boards/board.h"

namespace alidade {

/// Reads a board from the words of the command line; lengths carry mm, cm or m, "xN" counts as in Board:
/// - "chessboard:9x6:25mm": inner corners, side of a square;
/// - "charuco:8x6:30mm:22mm:5X5_100", with ":marker-first" behind where the top-left square holds a marker: squares,
///   side of a square, of a marker, dictionary;
/// - "aprilgrid:6x6:88mm:26.4mm", with ":APRILTAG_25h9" behind where it is not APRILTAG_36h11: tags, side of a tag,
/// gap. Throws InputError with the word at fault and an example.
Board parse_board(const std::string& text);

/// The words that parse_board reads back, lengths in mm to nine digits.
std::string board_text(const Board& board);

}  // namespace alidade
