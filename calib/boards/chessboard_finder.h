// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace alidade {

/// The inner corners of a chessboard in an image, to about a pixel: row by row, x along the rows, y down the columns.
///
/// Their order makes the board's frame right-handed for who looks at the print: from x to y one turns clockwise in the
/// image. Of the rotations that are left, that in which the square inside corner 0 (between corners 0, 1 and the two
/// below) is dark; where the pattern looks the same both ways round (columns + rows even), the one whose corner 0 lies
/// nearest to the image's top left, which is not the same corner of the board in every image. A mirrored image of a
/// chessboard looks like a chessboard: it is found, and nothing tells.
struct ChessboardGrid {
  int columns = 0;  ///< inner corners along a row
  int rows = 0;
  std::vector<Eigen::Vector2d> corners;  ///< px
};

/// The board of known size in a grey image of 8 bits, whole. Empty where it is not seen, or not all of it. Throws
/// std::invalid_argument for another type of image or a side of less than 3. Source: find_saddle_points and
/// grow_lattices, in the image at several sizes.
std::optional<ChessboardGrid> find_chessboard(const cv::Mat& grey, int columns, int rows);

/// The same without being told the size; columns >= rows, as which way the print is meant to lie nobody sees. Empty
/// for fewer than 12 corners, which chance lines up, too. What is half hidden may be taken for a smaller board: ask
/// several images, then most_common_size.
std::optional<ChessboardGrid> guess_chessboard(const cv::Mat& grey);

struct GridSize {
  int columns = 0;  ///< inner corners along a row
  int rows = 0;
  auto operator<=>(const GridSize&) const = default;
};

/// The size that most of the grids have, the larger one where two tie; empty without any.
std::optional<GridSize> most_common_size(std::span<const ChessboardGrid> grids);

}  // namespace alidade
