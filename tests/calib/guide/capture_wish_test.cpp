// SPDX-License-Identifier: Apache-2.0
#include "calib/guide/capture_wish.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "calib/cameras/lens_model.h"
#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

// What was taken with the camera so far.
struct Taken {
  Camera camera = test::simulated_camera(LensModel::Radial);
  BoardShape shape = shape_of(test::simulated_board());
  std::vector<BoardView> views{};
  CaptureCoverage coverage{std::vector<int>(20, 0), {}, 0, 0};
  std::vector<double> sigma_px{};

  std::optional<CaptureWish> wish() const { return next_wish({camera, shape, views, coverage, sigma_px, 40}, {}); }
};

BoardView seen(const Taken& taken, const Eigen::Isometry3d& T_camera_board) {
  BoardView view;
  for (const Eigen::Vector3d& corner : taken.shape.corners_m) {
    view.corners.push_back(
        {static_cast<int>(view.corners.size()), project(taken.camera, T_camera_board * corner)->pixel});
  }
  return view;
}

TEST(CaptureWish, ShowsTheWholeBoardAndReachesItsCell) {
  for (int cell = 0; cell < 20; ++cell) {
    Taken taken;
    taken.coverage.corners.assign(20, 10);
    taken.coverage.corners[static_cast<std::size_t>(cell)] = 0;
    const auto wish = taken.wish();
    ASSERT_TRUE(wish) << cell;
    EXPECT_EQ(wish->row * 5 + wish->column, cell);
    int reached = 0;
    for (const BoardCorner& corner : seen(taken, wish->T_camera_board).corners) {
      EXPECT_TRUE(is_inside(taken.camera, corner.pixel, 10)) << cell;
      const Eigen::Array2d in_cell = corner.pixel.array() - Eigen::Array2d(128 * wish->column, 120 * wish->row);
      reached += (in_cell > 0).all() && in_cell.x() < 128 && in_cell.y() < 120;
    }
    EXPECT_GE(reached, 3) << cell;
  }
}

TEST(CaptureWish, IsOfTheEmptyCellThatIsKnownLeast) {
  Taken taken;
  taken.sigma_px.assign(20, 1.0);
  taken.sigma_px[7] = 2;
  taken.sigma_px[12] = 3;
  taken.coverage.corners[12] = 5;
  auto wish = taken.wish();
  ASSERT_TRUE(wish);
  EXPECT_EQ(wish->row * 5 + wish->column, 7);
  taken.coverage.corners.assign(20, 5);  // with nothing empty the least known one
  wish = taken.wish();
  ASSERT_TRUE(wish);
  EXPECT_EQ(wish->row * 5 + wish->column, 12);
}

TEST(CaptureWish, BeginsAtTheImagesCornersWhileNothingIsKnown) {
  const auto wish = Taken{}.wish();
  ASSERT_TRUE(wish);
  EXPECT_TRUE(wish->column == 0 || wish->column == 4);
  EXPECT_TRUE(wish->row == 0 || wish->row == 3);
}

TEST(CaptureWish, IsTiltedAsTheFewestViewsAre) {
  Taken taken;
  taken.coverage.tilted = {2, 1, 0, 1};
  EXPECT_EQ(taken.wish()->stance.tilt, BoardTilt::TopNearer);
  taken.coverage.tilted = {2, 1, 1, 0};
  EXPECT_EQ(taken.wish()->stance.tilt, BoardTilt::BottomNearer);
}

TEST(CaptureWish, IsFarAfterTwoNearViews) {
  Taken taken;
  EXPECT_GE(taken.wish()->stance.image_share, 0.5);
  taken.coverage.near = 2;
  EXPECT_LE(taken.wish()->stance.image_share, 0.35);
  taken.coverage.far = 1;
  EXPECT_GE(taken.wish()->stance.image_share, 0.5);
}

TEST(CaptureWish, RepeatsNoView) {
  Taken taken;
  for (int i = 0; i < 12; ++i) {  // the coverage is left as it was: the same would be wished for again
    const auto wish = taken.wish();
    ASSERT_TRUE(wish) << i;
    const BoardView wished = seen(taken, wish->T_camera_board);
    for (const BoardView& view : taken.views) {
      double sum = 0;
      for (std::size_t c = 0; c < 54; ++c) sum += (view.corners[c].pixel - wished.corners[c].pixel).squaredNorm();
      EXPECT_GE(std::sqrt(sum / 54), 40) << i;
    }
    taken.views.push_back(wished);
  }
}

TEST(CaptureWish, OutlinesTheBoard) {
  const Taken taken;
  const auto wish = taken.wish();
  ASSERT_TRUE(wish);
  const BoardView view = seen(taken, wish->T_camera_board);
  for (const auto& [end, id] : {std::pair(0, 0), {1, 8}, {2, 53}, {3, 45}}) {
    EXPECT_LT(
        (wish->outline_px[static_cast<std::size_t>(end)] - view.corners[static_cast<std::size_t>(id)].pixel).norm(),
        1e-9);
  }
}

TEST(CaptureWish, IsForAFisheyeToo) {
  Taken taken;
  taken.camera = test::simulated_camera(LensModel::Fisheye);
  const auto wish = taken.wish();
  ASSERT_TRUE(wish);
  for (const BoardCorner& corner : seen(taken, wish->T_camera_board).corners) {
    EXPECT_TRUE(is_inside(taken.camera, corner.pixel));
  }
}

}  // namespace
}  // namespace alidade
