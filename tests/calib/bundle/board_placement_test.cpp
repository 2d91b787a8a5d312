// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/board_placement.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

constexpr LensModel kLenses[] = {LensModel::Radial, LensModel::Brown, LensModel::Rational, LensModel::Fisheye};

TEST(PlaceBoard, FindsThePoseOfExactViews) {
  for (const LensModel lens : kLenses) {
    test::Simulation exact{.views = 5, .sigma_px = 1e-4};
    exact.warp = {0.0005, 0.0002};
    const auto simulated = test::simulate_bundle(test::simulated_camera(lens), exact, 2);
    for (std::size_t i = 0; i < simulated.views.size(); ++i) {
      const auto T =
          place_board(simulated.truth.cameras[0].camera, simulated.shape, exact.warp, simulated.views[i].corners);
      ASSERT_TRUE(T) << name_of(lens);
      EXPECT_LT(difference(simulated.truth.T_rig_board[i], *T).norm(), 1e-7) << name_of(lens) << " " << i;
    }
  }
}

// Six corners around a square, the least that are taken.
TEST(PlaceBoard, NeedsSixCornersOffALine) {
  const auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Brown), {.views = 1}, 2);
  const auto place = [&](const std::vector<int>& ids) {
    std::vector<BoardCorner> some;
    for (const int id : ids) some.push_back(simulated.views[0].corners[static_cast<std::size_t>(id)]);
    return place_board(simulated.truth.cameras[0].camera, simulated.shape, {}, some);
  };
  EXPECT_TRUE(place({0, 4, 8, 45, 49, 53}));
  EXPECT_FALSE(place({0, 4, 8, 45, 49}));
  EXPECT_FALSE(place({}));
  EXPECT_FALSE(place({0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

// The two poses that a plane allows lie some 40 degrees apart at these tilts; noise of 0.3 px moves the right one by
// less than five degrees.
TEST(PlaceBoard, TakesTheBetterOfTheTwoPoses) {
  const Camera camera = test::simulated_camera(LensModel::Radial);
  const auto simulated = test::simulate_bundle(camera, {.views = 20, .noise_px = 0.3}, 6);
  for (std::size_t i = 0; i < simulated.views.size(); ++i) {
    const auto T = place_board(camera, simulated.shape, {}, simulated.views[i].corners);
    ASSERT_TRUE(T) << i;
    EXPECT_LT(rotation_angle(T->linear().transpose() * simulated.truth.T_rig_board[i].linear()), 0.09) << i;
  }
}

TEST(PlaceBoard, LeavesLessThanTheTruth) {
  const Camera camera = test::simulated_camera(LensModel::Brown);
  const auto simulated = test::simulate_bundle(camera, {.views = 5, .noise_px = 0.2}, 4);
  BundleFreedom none;
  none.warp = none.camera_poses = false;
  for (std::size_t i = 0; i < simulated.views.size(); ++i) {
    BundleView alone = simulated.views[i];
    alone.frame = 0;
    const auto cost_at = [&](const Eigen::Isometry3d& T) {
      return bundle_cost({simulated.truth.cameras, {T}, {}}, simulated.shape, std::span(&alone, 1), none);
    };
    EXPECT_LT(cost_at(*place_board(camera, simulated.shape, {}, alone.corners)),
              cost_at(simulated.truth.T_rig_board[i]));
  }
}

}  // namespace
}  // namespace alidade
