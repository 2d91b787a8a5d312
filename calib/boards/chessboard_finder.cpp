// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/chessboard_finder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include <Eigen/LU>
#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/boards/saddle_lattice.h"
#include "calib/boards/saddle_points.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

// Of the image that is searched first: corners are found better and faster there than in 20 megapixels.
constexpr int kSearchSide = 1000;

struct ScaledImage {
  cv::Mat grey;
  double pixels_per_pixel = 1;  // of the original, along a side

  Vector2d original(const Vector2d& p) const { return pixels_per_pixel * (p.array() + 0.5) - 0.5; }
};

ScaledImage scale_to(const cv::Mat& grey, int longest_side) {
  ScaledImage scaled;
  scaled.pixels_per_pixel = static_cast<double>(std::max(grey.cols, grey.rows)) / longest_side;
  const double scale = 1 / scaled.pixels_per_pixel;
  cv::resize(grey, scaled.grey, {}, scale, scale, scale < 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
  return scaled;
}

// Longest sides of the images that are searched in turn: as most boards are found; for blurred ones; for small ones.
std::vector<int> search_sides(const cv::Mat& grey) {
  constexpr int kMostSide = 2000;
  const int longest = std::max(grey.cols, grey.rows);
  const int first = std::min(longest, kSearchSide);
  return {first, first / 2, std::min(2 * first, std::max(longest, kMostSide))};
}

// The centre of a square, of those around the inner corners, too: there by the step before.
Vector2d square_centre(const NodeRectangle& r, int column, int row) {
  const auto corner = [&](int x, int y) {
    const int inner_x = std::clamp(x, 0, r.columns - 1), inner_y = std::clamp(y, 0, r.rows - 1);
    const int back_x = std::clamp(2 * inner_x - x, 0, r.columns - 1),
              back_y = std::clamp(2 * inner_y - y, 0, r.rows - 1);
    return Vector2d(2 * r.pixels[inner_y * r.columns + inner_x] - r.pixels[back_y * r.columns + back_x]);
  };
  return 0.25 * (corner(column, row) + corner(column + 1, row) + corner(column, row + 1) + corner(column + 1, row + 1));
}

// Grey about a place; empty outside the image.
std::optional<double> brightness_at(const cv::Mat& grey, const Vector2d& place) {
  const cv::Rect patch(cvRound(place.x()) - 1, cvRound(place.y()) - 1, 3, 3);
  if ((patch & cv::Rect({}, grey.size())) != patch) return std::nullopt;
  return cv::mean(grey(patch))[0];
}

// Do squares side by side, those around the inner corners included, differ by as much in turns? Where chance lines
// saddle points up, they do not.
bool is_chequered(const cv::Mat& grey, const NodeRectangle& rectangle) {
  constexpr double kLeastCorrelation = 0.75;  // of differences with the pattern: reflections and hands hide some
  double sum = 0, sum_of_squares = 0, count = 0;
  const auto compare = [&](int column, int row, const cv::Point& step) {
    if (column + step.x >= rectangle.columns || row + step.y >= rectangle.rows) return;
    const auto here = brightness_at(grey, square_centre(rectangle, column, row));
    const auto next = brightness_at(grey, square_centre(rectangle, column + step.x, row + step.y));
    if (!here || !next) return;
    const double difference = *here - *next;
    sum += (column + row) % 2 == 0 ? difference : -difference;
    sum_of_squares += difference * difference;
    ++count;
  };
  for (int row = -1; row < rectangle.rows; ++row) {
    for (int column = -1; column < rectangle.columns; ++column) {
      compare(column, row, {1, 0});
      compare(column, row, {0, 1});
    }
  }
  return std::abs(sum) >= kLeastCorrelation * std::sqrt(count * sum_of_squares);
}

std::vector<ChessboardGrid> find_grids(const cv::Mat& grey, int longest_side) {
  const ScaledImage image = scale_to(grey, longest_side);
  std::vector<ChessboardGrid> grids;
  for (const Lattice& lattice : grow_lattices(find_saddle_points(image.grey))) {
    auto rectangle = whole_rectangle(lattice);
    if (!rectangle || !is_chequered(image.grey, *rectangle)) continue;
    ChessboardGrid& grid = grids.emplace_back(rectangle->columns, rectangle->rows, std::move(rectangle->pixels));
    for (Vector2d& corner : grid.corners) corner = image.original(corner);
  }
  return grids;
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
  for (const int side : search_sides(grey)) {
    for (const ChessboardGrid& grid : find_grids(grey, side)) {
      if (grid.columns == columns && grid.rows == rows) return ordered(grey, grid);
      if (grid.columns == rows && grid.rows == columns) return ordered(grey, transposed(grid));
    }
  }
  return std::nullopt;
}

std::optional<ChessboardGrid> guess_chessboard(const cv::Mat& grey) {
  constexpr std::size_t kLeastCorners = 12;  // texture and noise line up nine by chance
  check(grey, "guess_chessboard");
  for (const int side : search_sides(grey)) {
    auto grids = find_grids(grey, side);
    std::erase_if(grids, [](const ChessboardGrid& g) { return g.corners.size() < kLeastCorners; });
    if (grids.empty()) continue;
    const ChessboardGrid& grid = *std::ranges::max_element(grids, {}, [](const auto& g) { return g.corners.size(); });
    return ordered(grey, grid.columns < grid.rows ? transposed(grid) : grid);
  }
  return std::nullopt;
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
