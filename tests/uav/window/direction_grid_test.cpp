// SPDX-License-Identifier: Apache-2.0
#include "uav/window/direction_grid.h"

#include <random>

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::vector<Eigen::Vector3d> directions_about(const Eigen::Vector3d& axis, double spread, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, spread);
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    directions.push_back((axis + Eigen::Vector3d(normal(random), normal(random), normal(random))).normalized());
  }
  return directions;
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return 2.0 * std::asin(0.5 * (a - b).norm());
}

TEST(DirectionGrid, MissesNoneThatIsNear) {
  for (const double spread : {0.01, 0.1, 0.5, 3.0}) {
    const auto directions = directions_about(Eigen::Vector3d(0.6, -0.8, 0.0), spread, 60, 1);
    const DirectionGrid grid(directions);
    for (const Eigen::Vector3d& u : directions_about(Eigen::Vector3d(0.6, -0.8, 0.0), 1.5 * spread, 200, 2)) {
      for (const double radius : {0.003, 0.05, 0.4}) {
        std::vector<bool> is_visited(directions.size(), false);
        grid.visit_near(u, radius, [&](std::size_t i) {
          EXPECT_FALSE(is_visited[i]);
          is_visited[i] = true;
          return false;
        });
        for (std::size_t i = 0; i < directions.size(); ++i) {
          EXPECT_TRUE(is_visited[i] || angle(u, directions[i]) > radius);
        }
      }
    }
  }
}

TEST(DirectionGrid, LooksAtFewOfMany) {
  const auto directions = directions_about(Eigen::Vector3d::UnitX(), 0.1, 1000, 3);
  const DirectionGrid grid(directions);
  int visited = 0;
  for (const Eigen::Vector3d& u : directions) {
    grid.visit_near(u, 0.002, [&](std::size_t) { return ++visited < 0; });
  }
  EXPECT_LT(visited, 10 * 1000);
}

TEST(DirectionGrid, StopsWhereItIsTold) {
  const auto directions = directions_about(Eigen::Vector3d::UnitX(), 0.01, 20, 4);
  const DirectionGrid grid(directions);
  int visited = 0;
  EXPECT_TRUE(grid.visit_near(directions[5], 1.0, [&](std::size_t) { return ++visited == 3; }));
  EXPECT_EQ(visited, 3);
  EXPECT_FALSE(grid.visit_near(directions[5], 1.0, [](std::size_t) { return false; }));
}

TEST(DirectionGrid, HoldsNothingOrOne) {
  EXPECT_FALSE(DirectionGrid{}.visit_near(Eigen::Vector3d::UnitX(), 0.1, [](std::size_t) { return true; }));
  const std::vector<Eigen::Vector3d> one{Eigen::Vector3d::UnitY()};
  EXPECT_TRUE(DirectionGrid(one).visit_near(Eigen::Vector3d::UnitY(), 0.1, [](std::size_t i) { return i == 0; }));
}

}  // namespace
}  // namespace alidade
