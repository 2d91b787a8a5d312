// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "app/run_context.h"
#include "calib/boards/board.h"
#include "calib/boards/board_view.h"
#include "calib/cameras/camera_start.h"
#include "capture/frame_source.h"

namespace alidade {

/// The board to look for, and what was not told of it.
struct BoardChoice {
  Board board;
  bool is_guessed = false;
  bool scale_is_assumed = false;  ///< the side of a square is not known
};

/// The board that `text` (--board) says, or, where that is empty, the one that the first images of `source` show.
/// Throws InputError where the text says none, and where none is seen.
BoardChoice choose_board(const std::string& text, const std::string& source);

/// The same, from the next frames of an opened source, which are gone then.
BoardChoice choose_board(const std::string& text, const std::string& source, FrameSource& frames);

/// An image in which the board was looked for.
struct BoardImage {
  std::string name;
  bool has_board = false;
  cv::Mat thumbnail;  ///< grey, at most 480 px wide; of images with a board
};

/// All images of a source.
struct BoardImages {
  std::string source;
  ImageExtent image;
  bool has_times = false;
  std::vector<BoardImage> images;
  std::vector<BoardView> views;  ///< `frame`: index into images; of a long film the still, different ones, or all
  cv::Mat sample;                ///< the first image with a board, as it came
  int seen = 0;                  ///< images with a board, before views of a film are chosen
};

/// Which views of a film are kept: those to calibrate from, or all.
enum class FilmViews { StillAndDistinct, All };

/// Looks for the board in every image of a folder, glob, list or video. Throws InputError where an image is damaged or
/// of another size, where no image shows the board (then with what they seem to show), and for a live camera.
BoardImages read_board_images(const std::string& source, const Board& board, const RunContext& context,
                              FilmViews kept = FilmViews::StillAndDistinct);

}  // namespace alidade
