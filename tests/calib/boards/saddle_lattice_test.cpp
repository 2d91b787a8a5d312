// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/saddle_lattice.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Eigen::Vector2d;

constexpr int kColumns = 7, kRows = 5;

// In perspective and barrel-shaped: x along the first edge, steps of 12 to 20 px.
Vector2d bent_pixel(double x, double y) {
  const Vector2d plane = Vector2d(20 * x + 3 * y, 5 * x + 18 * y) / (1 + 0.06 * x);
  const Vector2d from_middle = plane - Vector2d(60, 40);
  return plane - from_middle * 1.5e-5 * from_middle.squaredNorm();
}

double direction_rad(const Vector2d& way) {
  return std::fmod(std::atan2(way.y(), way.x()) + std::numbers::pi, std::numbers::pi);
}

std::vector<SaddlePoint> saddle_points_of_board() {
  std::vector<SaddlePoint> points;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      SaddlePoint point{bent_pixel(x, y), {}, 10};
      point.edges_rad = {direction_rad(bent_pixel(x + 0.1, y) - bent_pixel(x - 0.1, y)),
                         direction_rad(bent_pixel(x, y + 0.1) - bent_pixel(x, y - 0.1))};
      if ((x + y) % 2) std::swap(point.edges_rad[0], point.edges_rad[1]);
      points.push_back(point);
    }
  }
  return points;
}

TEST(SaddleLattice, FollowsABentBoardRowByRow) {
  const auto lattices = grow_lattices(saddle_points_of_board());
  ASSERT_EQ(lattices.size(), 1u);
  const auto rectangle = whole_rectangle(lattices[0]);
  ASSERT_TRUE(rectangle);
  EXPECT_EQ(rectangle->columns, kColumns);
  EXPECT_EQ(rectangle->rows, kRows);
  for (int i = 0; i < kColumns * kRows; ++i) {
    EXPECT_LT((rectangle->pixels[i] - bent_pixel(i % kColumns, i / kColumns)).norm(), 1e-9) << i;
  }
}

TEST(SaddleLattice, LeavesOutWhatDoesNotAlternateOrIsWeak) {
  auto points = saddle_points_of_board();
  SaddlePoint same = points[kColumns - 1], weak = points[kColumns - 2];
  same.pixel = weak.pixel = bent_pixel(kColumns, 0);
  weak.strength = 1;
  points.push_back(same);
  points.push_back(weak);
  const auto lattices = grow_lattices(points);
  ASSERT_EQ(lattices.size(), 1u);
  EXPECT_EQ(lattices[0].size(), static_cast<std::size_t>(kColumns * kRows));
}

TEST(SaddleLattice, GrowsAroundMissingPoints) {
  auto points = saddle_points_of_board();
  points.erase(points.begin() + 2 * kColumns + 3);
  const auto lattices = grow_lattices(points);
  ASSERT_EQ(lattices.size(), 1u);
  EXPECT_EQ(lattices[0].size(), points.size());
}

TEST(SaddleLattice, KeepsTwoBoardsApart) {
  auto points = saddle_points_of_board();
  for (SaddlePoint point : saddle_points_of_board()) {
    point.pixel.x() += 300;
    points.push_back(point);
  }
  EXPECT_EQ(grow_lattices(points).size(), 2u);
}

TEST(SaddleLattice, NeedsPointsThatLieInOne) {
  EXPECT_TRUE(grow_lattices({}).empty());
  auto points = saddle_points_of_board();
  for (SaddlePoint& point : points) point.edges_rad = points[0].edges_rad;
  EXPECT_TRUE(grow_lattices(points).empty());
}

Lattice full_lattice(int columns, int rows) {
  Lattice lattice;
  for (int down = 0; down < rows; ++down) {
    for (int right = 0; right < columns; ++right) lattice.push_back({right - 2, down + 1, Vector2d(right, down)});
  }
  return lattice;
}

TEST(WholeRectangle, TakesAwayWhatLiesOutside) {
  auto lattice = full_lattice(6, 4);
  lattice.push_back({4, 2, Vector2d(6, 1)});
  const auto rectangle = whole_rectangle(lattice);
  ASSERT_TRUE(rectangle);
  EXPECT_EQ(rectangle->columns, 6);
  EXPECT_EQ(rectangle->rows, 4);
  EXPECT_EQ(rectangle->pixels[7], Vector2d(1, 1));
}

TEST(WholeRectangle, IsEmptyWhereALineIsHalfThere) {
  auto lattice = full_lattice(6, 4);
  lattice.pop_back();
  lattice.pop_back();
  EXPECT_FALSE(whole_rectangle(lattice));
}

TEST(WholeRectangle, IsEmptyWhereAStepIsUneven) {
  auto lattice = full_lattice(6, 4);
  lattice[8].pixel.x() += 0.15;
  EXPECT_TRUE(whole_rectangle(lattice));
  lattice[8].pixel.x() += 0.1;
  EXPECT_FALSE(whole_rectangle(lattice));
}

TEST(WholeRectangle, IsEmptyWhereNoneIsLeft) {
  EXPECT_FALSE(whole_rectangle({}));
  EXPECT_FALSE(whole_rectangle(full_lattice(9, 2)));
  auto holed = full_lattice(3, 3);
  holed.erase(holed.begin() + 4);
  EXPECT_FALSE(whole_rectangle(holed));
}

}  // namespace
}  // namespace alidade
