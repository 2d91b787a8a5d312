// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/chessboard_finder.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>

#include <Eigen/LU>
#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

using Eigen::Vector2d;

// Longer sides of the image that is searched: corners are found better and faster there than in 20 megapixels.
constexpr int kSearchSide = 1000, kGuessSide = 640;

struct ReducedImage {
  cv::Mat grey;
  double pixels_per_pixel = 1;  // of the original, along a side

  Vector2d original(const cv::Point2f& p) const { return pixels_per_pixel * (Vector2d(p.x, p.y).array() + 0.5) - 0.5; }
};

ReducedImage reduce(const cv::Mat& grey, int longest_side) {
  const int longest = std::max(grey.cols, grey.rows);
  if (longest <= longest_side) return {grey};
  ReducedImage reduced;
  reduced.pixels_per_pixel = static_cast<double>(longest) / longest_side;
  const double scale = 1 / reduced.pixels_per_pixel;
  cv::resize(grey, reduced.grey, {}, scale, scale, cv::INTER_AREA);
  return reduced;
}

ChessboardGrid original_grid(const ReducedImage& image, const cv::Size& size, const std::vector<cv::Point2f>& found) {
  ChessboardGrid grid{size.width, size.height, {}};
  for (const cv::Point2f& p : found) grid.corners.push_back(image.original(p));
  return grid;
}

using Search = bool (*)(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& corners);

bool search_squares(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& corners) {
  return cv::findChessboardCorners(grey, size, corners, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
}

bool search_crossings(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& corners) {
  return cv::findChessboardCornersSB(grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE);
}

std::optional<ChessboardGrid> find_at(const ReducedImage& image, const cv::Size& size, Search search) {
  std::vector<cv::Point2f> corners;
  if (!search(image.grey, size, corners)) return std::nullopt;
  return original_grid(image, size, corners);
}

ChessboardGrid transposed(const ChessboardGrid& grid) {
  ChessboardGrid result{grid.rows, grid.columns, {}};
  for (int row = 0; row < result.rows; ++row) {
    for (int column = 0; column < result.columns; ++column) {
      result.corners.push_back(grid.corners[column * grid.columns + row]);
    }
  }
  return result;
}

ChessboardGrid with_rows_reversed(ChessboardGrid grid) {
  for (auto row = grid.corners.begin(); row != grid.corners.end(); row += grid.columns) {
    std::reverse(row, row + grid.columns);
  }
  return grid;
}

ChessboardGrid turned_half(ChessboardGrid grid) {
  std::ranges::reverse(grid.corners);
  return grid;
}

bool is_right_handed(const ChessboardGrid& grid) {
  Eigen::Matrix2d sides;
  sides << grid.corners[grid.columns - 1] - grid.corners[0], grid.corners.back() - grid.corners[0];
  return sides.determinant() > 0;
}

// Mean grey of the squares of the first one's colour less that of the others.
double first_square_brightness(const cv::Mat& grey, const ChessboardGrid& grid) {
  double difference = 0;
  for (int row = 0; row + 1 < grid.rows; ++row) {
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const auto corner = grid.corners.begin() + row * grid.columns + column;
      const Vector2d centre = 0.25 * (corner[0] + corner[1] + corner[grid.columns] + corner[grid.columns + 1]);
      const int x = std::clamp(cvRound(centre.x()), 0, grey.cols - 1),
                y = std::clamp(cvRound(centre.y()), 0, grey.rows - 1);
      difference += ((row + column) % 2 ? -1 : 1) * grey.at<uchar>(y, x);
    }
  }
  return difference;
}

ChessboardGrid ordered(const cv::Mat& grey, ChessboardGrid grid) {
  if (!is_right_handed(grid)) grid = with_rows_reversed(grid);
  std::vector<ChessboardGrid> ways{grid, turned_half(grid)};
  if (grid.columns == grid.rows) {
    const ChessboardGrid quarter = with_rows_reversed(transposed(grid));
    ways.push_back(quarter);
    ways.push_back(turned_half(quarter));
  }
  return *std::ranges::min_element(ways, {}, [&](const ChessboardGrid& way) {
    return std::tuple(first_square_brightness(grey, way) > 0, way.corners[0].sum());
  });
}

void check(const cv::Mat& grey, const char* function) {
  if (grey.type() != CV_8UC1) {
    throw std::invalid_argument(fmt::format("{}: the image must be grey, of 8 bits", function));
  }
}

}  // namespace

std::optional<ChessboardGrid> find_chessboard(const cv::Mat& grey, int columns, int rows) {
  check(grey, "find_chessboard");
  if (columns < 3 || rows < 3) {
    throw std::invalid_argument(fmt::format("find_chessboard: at least 3x3 corners, got {}x{}", columns, rows));
  }
  const cv::Size size(columns, rows);
  const ReducedImage reduced = reduce(grey, kSearchSide);
  // Squares first: five times as fast as crossings where the board is there. On the recordings each finds what the
  // other misses.
  auto found = find_at(reduced, size, search_squares);
  if (!found) found = find_at(reduced, size, search_crossings);
  if (!found && reduced.pixels_per_pixel > 1) found = find_at({grey}, size, search_squares);
  if (!found) return std::nullopt;
  return ordered(grey, *found);
}

std::optional<ChessboardGrid> guess_chessboard(const cv::Mat& grey) {
  check(grey, "guess_chessboard");
  const ReducedImage reduced = reduce(grey, kGuessSide);
  std::vector<cv::Point2f> corners;
  cv::Mat marks;  // one entry for each corner: its size is that of the grid
  if (!cv::findChessboardCornersSB(reduced.grey, {3, 3}, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER,
                                   marks)) {
    return std::nullopt;
  }
  const ChessboardGrid grid = original_grid(reduced, marks.size(), corners);
  return ordered(grey, grid.columns < grid.rows ? transposed(grid) : grid);
}

std::optional<GridSize> most_common_size(std::span<const ChessboardGrid> grids) {
  std::map<GridSize, int> counts;
  for (const ChessboardGrid& grid : grids) ++counts[{grid.columns, grid.rows}];
  if (counts.empty()) return std::nullopt;
  return std::ranges::max_element(
             counts, {},
             [](const auto& entry) { return std::tuple(entry.second, entry.first.columns * entry.first.rows); })
      ->first;
}

}  // namespace alidade
