// SPDX-License-Identifier: Apache-2.0
#include "calib/guide/capture_estimate.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/pose.h"
#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

constexpr ImageExtent kImage{640, 480};

std::optional<CaptureEstimate> estimate_from(const test::SimulatedViews& simulated) {
  return estimate_camera(LensModel::Radial, kImage, shape_of(test::simulated_board()), simulated.views, {});
}

TEST(CaptureEstimate, FindsTheCameraAndWhereTheBoardsStood) {
  const Camera truth = test::simulated_camera(LensModel::Radial);
  const test::SimulatedViews simulated = test::simulate_views(truth, {.noise_px = 0.1}, 3);
  const auto estimate = estimate_from(simulated);
  ASSERT_TRUE(estimate);
  EXPECT_LT(std::abs(estimate->camera.fx / truth.fx - 1), 4 * estimate->focal_sigma);
  EXPECT_LT(estimate->focal_sigma, 0.01);
  ASSERT_EQ(estimate->T_camera_board.size(), simulated.T_camera_board.size());
  for (std::size_t i = 0; i < estimate->T_camera_board.size(); ++i) {
    EXPECT_LT(rotation_angle(estimate->T_camera_board[i].linear().transpose() * simulated.T_camera_board[i].linear()),
              0.02);
  }
  EXPECT_NEAR(estimate->rms_px, 0.1 * std::sqrt(2.0), 0.02);
}

TEST(CaptureEstimate, KnowsLeastWhereNoBoardWasSeen) {
  test::SimulatedViews simulated = test::simulate_views(test::simulated_camera(LensModel::Radial),
                                                        {.views = 30, .noise_px = 0.1, .distance = 2.5}, 4);
  std::erase_if(simulated.views, [](const BoardView& view) {  // the right third is empty
    return std::any_of(view.corners.begin(), view.corners.end(),
                       [](const BoardCorner& c) { return c.pixel.x() > 420; });
  });
  ASSERT_GE(simulated.views.size(), 5U);
  const auto estimate = estimate_from(simulated);
  ASSERT_TRUE(estimate);
  ASSERT_EQ(estimate->cell_sigma_px.size(), 20U);
  const auto& sigma = estimate->cell_sigma_px;
  EXPECT_GT(sigma[9], 2 * sigma[5]);  // the middle of the right edge and that of the left one
  EXPECT_GT(sigma[14], 2 * sigma[10]);
  EXPECT_LT(estimate->centre_px, sigma[4]);
  EXPECT_EQ(estimate->worst_px, *std::max_element(sigma.begin(), sigma.end()));
  EXPECT_EQ(estimate->corner_px, std::max({sigma[0], sigma[4], sigma[15], sigma[19]}));
}

TEST(CaptureEstimate, IsEmptyWhereTheViewsDoNotTell) {
  const Camera truth = test::simulated_camera(LensModel::Radial);
  EXPECT_FALSE(estimate_from({}));
  EXPECT_FALSE(estimate_from(test::simulate_views(truth, {.views = 1, .noise_px = 0.1}, 1)));
  EXPECT_FALSE(estimate_from(test::simulate_views(truth, {.views = 4, .noise_px = 0.1, .most_tilt = 0}, 1)));
}

}  // namespace
}  // namespace alidade
