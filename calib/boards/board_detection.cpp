// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_detection.h"

#include <stdexcept>

#include <opencv2/imgproc.hpp>

#include "calib/boards/chessboard_detection.h"
#include "calib/boards/marker_detection.h"

namespace alidade {

std::optional<BoardView> detect_board(const cv::Mat& image, const Board& board) {
  cv::Mat grey = image;
  if (image.type() == CV_8UC3) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  if (grey.type() != CV_8UC1) throw std::invalid_argument("detect_board: the image must be grey or BGR, of 8 bits");
  return board.kind == BoardKind::Chessboard ? detect_chessboard(grey, board) : detect_markers_board(grey, board);
}

}  // namespace alidade
