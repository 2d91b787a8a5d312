// SPDX-License-Identifier: Apache-2.0
#include "calib/guide/capture_coverage.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

constexpr ImageExtent kImage{500, 400};  // cells of 100 px

BoardView corners_at(const std::vector<Eigen::Vector2d>& pixels) {
  BoardView view;
  for (const auto& pixel : pixels) view.corners.push_back({static_cast<int>(view.corners.size()), pixel});
  return view;
}

TEST(CaptureCoverage, CountsTheCornersOfAllViewsByCell) {
  const std::vector<BoardView> views{corners_at({{10, 10}, {99.4, 99.4}, {99.6, 10}}), corners_at({{50, 50}})};
  const std::vector<std::optional<BoardStance>> stances(2);
  const CoverageOptions options;
  const CaptureCoverage coverage = coverage_of(kImage, views, stances, options);
  ASSERT_EQ(coverage.corners.size(), 20U);
  EXPECT_EQ(coverage.corners[0], 3);
  EXPECT_EQ(coverage.corners[1], 1);
  EXPECT_EQ(shares_of(coverage, options).positions, 1.0 / 20);  // one corner does not fill a cell
}

TEST(CaptureCoverage, CountsCornersAtTheBorder) {
  const std::vector<BoardView> views{corners_at({{-0.5, -0.5}, {499.5, 399.5}, {501, 200}})};
  const CaptureCoverage coverage = coverage_of(kImage, views, std::vector<std::optional<BoardStance>>(1), {});
  EXPECT_EQ(coverage.corners[0], 1);
  EXPECT_EQ(coverage.corners[19], 1);
  EXPECT_EQ(coverage.corners[14], 1);
}

TEST(CaptureCoverage, IsCompleteWithAllTiltsAndBothDistances) {
  const CoverageOptions options;
  std::vector<std::optional<BoardStance>> stances{std::nullopt};
  for (const BoardTilt tilt : kTilts) stances.push_back(BoardStance{Eigen::Vector2d(1, 1), tilt, 0.5, 0.6});
  std::vector<BoardView> views(5);
  CaptureCoverage coverage = coverage_of(kImage, views, stances, options);
  coverage.corners.assign(20, 3);
  EXPECT_EQ(coverage.near, 4);
  EXPECT_EQ(shares_of(coverage, options).tilts, 1);
  EXPECT_EQ(shares_of(coverage, options).distances, 0.5);
  EXPECT_FALSE(is_complete(shares_of(coverage, options), options));
  coverage.far = 1;
  EXPECT_TRUE(is_complete(shares_of(coverage, options), options));
  coverage.tilted[2] = 0;
  EXPECT_EQ(shares_of(coverage, options).tilts, 0.75);
  EXPECT_FALSE(is_complete(shares_of(coverage, options), options));
  coverage.tilted[2] = 1;
  for (std::size_t i = 0; i < 5; ++i) coverage.corners[i] = 2;  // 15 of 20 are left
  EXPECT_FALSE(is_complete(shares_of(coverage, options), options));
  coverage.corners[0] = 3;
  EXPECT_TRUE(is_complete(shares_of(coverage, options), options));
}

TEST(CaptureCoverage, RefusesWhatCannotBe) {
  EXPECT_THROW(coverage_of(kImage, std::vector<BoardView>(2), {}, {}), std::invalid_argument);
  CoverageOptions options;
  options.far_share = 0.6;
  try {
    validate(options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "far_share must lie in (0, near_share], got 0.6");
  }
}

TEST(CellCentre, IsInTheMiddleOfTheCell) {
  EXPECT_EQ(cell_centre_px(kImage, {}, 0, 0), Eigen::Vector2d(49.5, 49.5));
  EXPECT_EQ(cell_centre_px(kImage, {}, 4, 3), Eigen::Vector2d(449.5, 349.5));
}

}  // namespace
}  // namespace alidade
