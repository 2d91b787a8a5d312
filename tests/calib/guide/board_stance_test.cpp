// SPDX-License-Identifier: Apache-2.0
#include "calib/guide/board_stance.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "calib/cameras/lens_model.h"
#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Corners of 0.2 m x 0.125 m, 1 m before a camera of 640 px: 0.2 / 640 * 500 of its width.
TEST(BoardStance, OfAFacingBoardIsItsPlaceAndSize) {
  const Camera camera = start_camera(LensModel::Radial, 640, 480, 500);
  const BoardShape shape = shape_of(test::simulated_board());
  const auto stance = stance_of(camera, shape, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1)), 15 * kDegree);
  ASSERT_TRUE(stance);
  EXPECT_NEAR(stance->centre_px.x(), 319.5 + 50, 1e-9);  // 0.1 m to the right
  EXPECT_NEAR(stance->centre_px.y(), 239.5 + 31.25, 1e-9);
  EXPECT_EQ(stance->tilt, BoardTilt::Facing);
  EXPECT_NEAR(stance->tilt_rad, 0, 1e-9);
  EXPECT_NEAR(stance->image_share, 0.2 * 500 / 640, 1e-12);
}

// The side that is called nearer is so: the depth of the board's corners grows away from it, wherever they are seen.
TEST(BoardStance, NamesTheNearerSide) {
  const BoardShape shape = shape_of(test::simulated_board());
  for (const LensModel lens : {LensModel::Radial, LensModel::Fisheye}) {
    const Camera camera = test::simulated_camera(lens);
    for (const BoardTilt tilt : kTilts) {
      const auto T = pose_with(camera, shape, {{320, 240}, tilt, 30 * kDegree, 0.3});
      ASSERT_TRUE(T);
      const Eigen::Vector3d origin = *T * shape.corners_m.front(), right = *T * shape.corners_m[8],
                            below = *T * shape.corners_m[45];
      const double along = right.z() - origin.z(), down = below.z() - origin.z();
      SCOPED_TRACE(name_of(tilt));
      EXPECT_EQ(along > 0.05, tilt == BoardTilt::LeftNearer);
      EXPECT_EQ(along < -0.05, tilt == BoardTilt::RightNearer);
      EXPECT_EQ(down > 0.05, tilt == BoardTilt::TopNearer);
      EXPECT_EQ(down < -0.05, tilt == BoardTilt::BottomNearer);
    }
  }
}

TEST(PoseWith, IsTheInverseOfStanceOf) {
  const BoardShape shape = shape_of(test::simulated_board());
  for (const LensModel lens : {LensModel::Radial, LensModel::Rational, LensModel::Fisheye}) {
    const Camera camera = test::simulated_camera(lens);
    for (const BoardTilt tilt : kTilts) {
      const BoardStance wanted{{500, 100}, tilt, 0.4, 0.45};
      const auto T = pose_with(camera, shape, wanted);
      ASSERT_TRUE(T);
      const auto found = stance_of(camera, shape, *T, 0.2);
      ASSERT_TRUE(found);
      EXPECT_LT((found->centre_px - wanted.centre_px).norm(), 1e-6);
      EXPECT_EQ(found->tilt, tilt);
      EXPECT_NEAR(found->tilt_rad, 0.4, 1e-9);
      EXPECT_NEAR(found->image_share, 0.45, 1e-9);
    }
  }
}

// Six columns and nine rows: upright it would just fit at 0.6 of the share that it has when turned.
TEST(PoseWith, TurnsATallBoardToFitIntoAWideImage) {
  Board tall = test::simulated_board();
  std::swap(tall.columns, tall.rows);
  const Camera camera = start_camera(LensModel::Radial, 640, 480, 500);
  const BoardShape shape = shape_of(tall);
  const auto T = pose_with(camera, shape, {{319.5, 239.5}, BoardTilt::Facing, 0, 0.9});
  ASSERT_TRUE(T);
  double width_px = 0;
  for (const Eigen::Vector3d& corner : shape.corners_m) {
    const Eigen::Vector2d pixel = project(camera, *T * corner)->pixel;
    EXPECT_TRUE(is_inside(camera, pixel));
    width_px = std::max(width_px, 2 * std::abs(pixel.x() - 319.5));
  }
  EXPECT_NEAR(width_px, 0.9 * 640, 1e-6);
}

TEST(BoardStance, IsEmptyBehindTheCameraAndWhereTheLensIsBlind) {
  const BoardShape shape = shape_of(test::simulated_board());
  Camera camera = test::simulated_camera(LensModel::Radial);
  EXPECT_FALSE(stance_of(camera, shape, Eigen::Isometry3d(Eigen::Translation3d(0, 0, -1)), 0.2));
  camera.distortion = BrownConrady{-0.9};
  EXPECT_FALSE(pose_with(camera, shape, {{5, 5}, BoardTilt::Facing, 0, 0.3}));
  EXPECT_THROW(pose_with(camera, shape, {{320, 240}, BoardTilt::Facing, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
