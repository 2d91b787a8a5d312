// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/quadratic_map.h"

#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

Eigen::Vector2d truth(const Eigen::Vector2d& p) {
  return {3 + 100 * p.x() - 20 * p.y() + 500 * p.x() * p.x(), 7 + 90 * p.y() + 300 * p.x() * p.y()};
}

struct Samples {
  std::vector<Eigen::Vector2d> places, values;
};

Samples sample(int columns, int rows) {
  Samples samples;
  for (int i = 0; i < columns * rows; ++i) {
    samples.places.emplace_back(0.01 * (i % columns), 0.01 * (i / columns));
    samples.values.push_back(truth(samples.places.back()));
  }
  return samples;
}

TEST(QuadraticMap, IsExactForItsOwnKind) {
  const Samples samples = sample(5, 3);
  const auto map = QuadraticMap::fit(samples.places, samples.values, {0.01, 0.01}, 0.02);
  ASSERT_TRUE(map);
  EXPECT_LT((map->at({0.035, 0.002}) - truth({0.035, 0.002})).norm(), 1e-9);
}

TEST(QuadraticMap, IsNotMovedByOneThatIsOff) {
  Samples samples = sample(5, 5);
  samples.values[7] += Eigen::Vector2d(5, -3);
  const auto map = QuadraticMap::fit(samples.places, samples.values, {0.02, 0.02}, 0.02);
  ASSERT_TRUE(map);
  EXPECT_LT((map->at({0.02, 0.01}) - truth({0.02, 0.01})).norm(), 1e-9);
}

TEST(QuadraticMap, NeedsEightPointsInThreeRowsAndColumns) {
  const Samples few = sample(3, 2), flat = sample(5, 2);
  EXPECT_FALSE(QuadraticMap::fit(few.places, few.values, {0, 0}, 0.02));
  EXPECT_FALSE(QuadraticMap::fit(flat.places, flat.values, {0, 0}, 0.02));
}

}  // namespace
}  // namespace alidade
