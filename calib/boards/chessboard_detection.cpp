// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/chessboard_detection.h"

#include <stdexcept>

#include "calib/boards/chessboard_finder.h"

namespace alidade {

std::optional<BoardView> detect_chessboard(const cv::Mat& grey, const Board& board,
                                           const CornerRefinementOptions& options) {
  if (board.kind != BoardKind::Chessboard)
    throw std::invalid_argument("detect_chessboard: the board is of another kind");
  if (const auto fault = find_fault(board)) throw std::invalid_argument("detect_chessboard: " + *fault);
  const auto grid = find_chessboard(grey, board.columns, board.rows);
  if (!grid) return std::nullopt;
  std::vector<BoardCorner> found;
  for (const Eigen::Vector2d& pixel : grid->corners) found.push_back({static_cast<int>(found.size()), pixel});
  BoardView view;
  view.corners = refine_corners(grey, found, board.columns, options);
  return view;
}

}  // namespace alidade
