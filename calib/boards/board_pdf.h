// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "calib/boards/board.h"

namespace alidade {

/// What a board is printed on. Fitted: a page of the board's own size, for plotters and print shops.
enum class Paper { A4, A3, A2, A1, A0, Letter, Fitted };

/// The bytes of a PDF file of one page with the board to scale: black rectangles in one path, a ruler of 100 mm to
/// check the print with, and a line that names the board in the words of parse_board. The page is turned where the
/// board needs it. At least 8 mm around the pattern stay white. Throws InputError where the board does not fit on the
/// paper, naming the smallest on which it does; std::invalid_argument as pattern_of.
std::string board_pdf(const Board& board, Paper paper = Paper::A4);

}  // namespace alidade
