// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/bundle_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"
#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

BundleFreedom free_lens(LensModel lens) {
  BundleFreedom freedom;
  freedom.intrinsics = {free_intrinsics(lens)};
  return freedom;
}

test::SimulatedBundle noisy_views(double noise_px) {
  return test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.views = 12, .noise_px = noise_px}, 11);
}

int cut_corners(const BundleView& view) {
  return static_cast<int>(std::count(view.weights.begin(), view.weights.end(), 0.0));
}

// One corner in 3000 of a normal distribution lies beyond 4 sigmas; there are 648.
TEST(FitBundle, CutsNextToNothingOfNormalNoise) {
  const auto simulated = noisy_views(0.2);
  const BundleFit fit = fit_bundle(simulated.truth, simulated.shape, simulated.views, free_lens(LensModel::Radial));
  EXPECT_TRUE(fit.converged);
  int cut = 0;
  for (const BundleView& view : fit.views) cut += cut_corners(view);
  EXPECT_LE(cut, 3);
  EXPECT_NEAR(fit.scale, 2.0, 0.15);  // noise of 0.2 px where the corners state 0.1
  ASSERT_EQ(fit.view_scale.size(), 12U);
  for (const double scale : fit.view_scale) EXPECT_NEAR(scale, 2.0, 0.8);
}

TEST(FitBundle, CutsTheOutliersAndOnlyThem) {
  auto simulated = noisy_views(0.1);
  test::RandomGeometry random(3);
  for (std::size_t v = 0; v < simulated.views.size(); ++v) {
    for (std::size_t i = v % 3; i < 54; i += 9) {  // six of each view, 2 to 20 px off
      simulated.views[v].corners[i].pixel += random.uniform(2, 20) * random.direction().head<2>().normalized();
    }
  }
  const auto freedom = free_lens(LensModel::Radial);
  const BundleFit fit = fit_bundle(simulated.truth, simulated.shape, simulated.views, freedom);
  for (std::size_t v = 0; v < simulated.views.size(); ++v) {
    for (std::size_t i = 0; i < 54; ++i) simulated.views[v].weights[i] = i % 9 == v % 3 ? 0 : 1;
    EXPECT_EQ(fit.views[v].weights, simulated.views[v].weights) << v;
  }
  const auto without = solve_bundle(simulated.truth, simulated.shape, simulated.views, freedom);
  EXPECT_LT(test::largest_difference_px(without.bundle.cameras[0].camera, fit.bundle.cameras[0].camera), 1e-3);
}

TEST(FitBundle, CutsMostOfAWreckedViewAndSaysItsScatter) {
  auto simulated = noisy_views(0.1);
  test::RandomGeometry random(4);
  for (BoardCorner& corner : simulated.views[5].corners) corner.pixel += random.vector(15).head<2>();
  const auto freedom = free_lens(LensModel::Radial);
  const BundleFit fit = fit_bundle(simulated.truth, simulated.shape, simulated.views, freedom);
  EXPECT_GT(cut_corners(fit.views[5]), 45);
  EXPECT_GT(fit.view_scale[5], 20 * fit.scale);
  for (std::size_t v = 0; v < 12; ++v) {
    EXPECT_LE(cut_corners(fit.views[v]), v == 5 ? 54 : 1) << v;
  }
  simulated.views.erase(simulated.views.begin() + 5);
  const BundleFit without = fit_bundle(simulated.truth, simulated.shape, simulated.views, freedom);
  // What few of its corners lie within the tolerance by chance moves the fit by less than a tenth of what noise does.
  const double noise = test::largest_difference_px(simulated.truth.cameras[0].camera, without.bundle.cameras[0].camera);
  EXPECT_LT(test::largest_difference_px(without.bundle.cameras[0].camera, fit.bundle.cameras[0].camera), 0.1 * noise);
}

// Two cameras, the second of which shows the board of another moment once: 54 corners that agree with each other, and
// lie a hundred pixels off.
TEST(FitBundle, CutsAViewOfAnotherMoment) {
  Eigen::Isometry3d T_rig_camera(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  T_rig_camera.translation().x() = 0.08;
  const Camera camera = test::simulated_camera(LensModel::Radial);
  const std::vector<BundleCamera> cameras{{camera, Eigen::Isometry3d::Identity()}, {camera, T_rig_camera}};
  const auto rig = test::simulate_rig(cameras, std::vector<std::vector<int>>(8, {0, 1}), {.noise_px = 0.1}, 5);
  std::vector<BundleView> views;
  for (int c = 0; c < 2; ++c) {
    for (const BoardView& view : rig.cameras[static_cast<std::size_t>(c)].views) {
      views.push_back({c, view.frame, view.corners, std::vector<double>(54, 1.0)});
    }
  }
  views[10].corners = views[14].corners;
  auto freedom = free_lens(LensModel::Radial);
  freedom.intrinsics.push_back(freedom.intrinsics.front());
  const BundleFit fit = fit_bundle({cameras, rig.T_rig_board, {}}, shape_of(test::simulated_board()), views, freedom);
  for (std::size_t v = 0; v < 16; ++v) {
    if (v == 10) {
      EXPECT_EQ(cut_corners(fit.views[v]), 54);
    } else {
      EXPECT_LE(cut_corners(fit.views[v]), 1) << v;
    }
  }
  EXPECT_NEAR(fit.scale, 1, 0.2);
}

// Corners of a blurred view scatter by twice as much as the others: too much for the others' 4 sigmas, not for its own.
TEST(FitBundle, JudgesAViewByItsOwnScatter) {
  auto simulated = noisy_views(0.1);
  test::RandomGeometry random(5);
  for (BoardCorner& corner : simulated.views[5].corners) corner.pixel += random.vector(0.25).head<2>();
  const auto freedom = free_lens(LensModel::Radial);
  EXPECT_LE(cut_corners(fit_bundle(simulated.truth, simulated.shape, simulated.views, freedom).views[5]), 1);
  BundleFitOptions alike;
  alike.view_scale_limit = 1;
  EXPECT_GT(cut_corners(fit_bundle(simulated.truth, simulated.shape, simulated.views, freedom, alike).views[5]), 5);
}

TEST(FitBundle, GivesTheSameTwice) {
  const auto simulated = noisy_views(0.3);
  const auto freedom = free_lens(LensModel::Radial);
  const BundleFit first = fit_bundle(simulated.truth, simulated.shape, simulated.views, freedom);
  const BundleFit second = fit_bundle(simulated.truth, simulated.shape, simulated.views, freedom);
  EXPECT_EQ(first.bundle.cameras[0].camera, second.bundle.cameras[0].camera);
  EXPECT_EQ(first.scale, second.scale);
}

// Two corners of the first view 3 and 4 px off, the second of them without weight.
TEST(RmsPx, IsOfLengthsOverTheCornersWithWeight) {
  auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.views = 1}, 1);
  auto& view = simulated.views[0];
  view.corners.resize(2);
  view.weights = {1.0, 0.0};
  view.corners[0].pixel.x() += 3;
  view.corners[1].pixel.y() += 4;
  EXPECT_NEAR(rms_px(simulated.truth, simulated.shape, simulated.views), 3, 1e-9);
  EXPECT_NEAR(rms_px(simulated.truth, simulated.shape, simulated.views, true), std::sqrt(12.5), 1e-9);
  view.weights[0] = 0;
  EXPECT_EQ(rms_px(simulated.truth, simulated.shape, simulated.views), 0);
  EXPECT_EQ(rms_px(simulated.truth, simulated.shape, {}, true), 0);
}

}  // namespace
}  // namespace alidade
