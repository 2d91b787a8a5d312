// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/residual_field.h"

#include <cmath>

#include <gtest/gtest.h>

#include "calib/cameras/camera_calibration.h"
#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

BundleFit at_truth(const test::SimulatedBundle& simulated) {
  BundleFit fit;
  fit.bundle = simulated.truth;
  fit.views = simulated.views;
  return fit;
}

test::SimulatedBundle views_with_noise(double noise_px, int views = 20) {
  return test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.views = views, .noise_px = noise_px}, 4);
}

TEST(ResidualField, HasSquareCellsOverTheImage) {
  const auto simulated = views_with_noise(0, 1);
  const ResidualField field = residual_field(at_truth(simulated), simulated.shape, 0, 8);
  EXPECT_EQ(field.columns, 8);
  EXPECT_EQ(field.rows, 6);
  ASSERT_EQ(field.cells.size(), 48U);
  EXPECT_EQ(field.cells[0].centre_px, Eigen::Vector2d(39.5, 39.5));  // of pixels 0 .. 79
  EXPECT_EQ(field.cells[9].centre_px, Eigen::Vector2d(119.5, 119.5));
}

TEST(ResidualField, CountsCornersWithWeightInTheirCells) {
  auto simulated = views_with_noise(0, 2);
  simulated.views[1].weights.assign(54, 0.0);
  const ResidualField field = residual_field(at_truth(simulated), simulated.shape, 0, 8);
  int count = 0;
  for (const ResidualCell& cell : field.cells) count += cell.count;
  EXPECT_EQ(count, 54);
  const Eigen::Vector2d pixel = simulated.views[0].corners[20].pixel;
  const auto cell =
      static_cast<std::size_t>(std::floor((pixel.y() + 0.5) / 80) * 8 + std::floor((pixel.x() + 0.5) / 80));
  EXPECT_GT(field.cells[cell].count, 0);
}

// Every corner lies (0.3, -0.4) px from where the camera images it: found minus seen is the opposite, 0.5 px long.
TEST(ResidualField, CallsAShiftSystematic) {
  auto simulated = views_with_noise(0);
  for (BundleView& view : simulated.views) {
    for (BoardCorner& corner : view.corners) corner.pixel += Eigen::Vector2d(0.3, -0.4);
  }
  const ResidualField field = residual_field(at_truth(simulated), simulated.shape, 0);
  EXPECT_NEAR(field.systematic_px, 0.5, 1e-9);
  EXPECT_NEAR(field.noise_px, 0, 1e-6);
  for (const ResidualCell& cell : field.cells) {
    const Eigen::Vector2d expected = cell.count > 0 ? Eigen::Vector2d(-0.3, 0.4) : Eigen::Vector2d::Zero();
    EXPECT_LT((cell.mean_px - expected).norm(), 1e-9);
  }
  EXPECT_FALSE(lens_fits(field));
}

// Noise of 0.2 px on each coordinate is 0.28 px long.
TEST(ResidualField, CallsNoiseNoise) {
  const auto simulated = views_with_noise(0.2, 30);
  const ResidualField field = residual_field(at_truth(simulated), simulated.shape, 0);
  EXPECT_NEAR(field.noise_px, 0.2 * std::sqrt(2.0), 0.015);
  EXPECT_LT(field.systematic_px, 0.05);
  EXPECT_TRUE(lens_fits(field));
}

// A fisheye's images fitted with k1 and k2 of Brown and Conrady.
TEST(ResidualField, TellsALensOfTheWrongKind) {
  const auto simulated =
      test::simulate_bundle(test::simulated_camera(LensModel::Fisheye), {.views = 20, .noise_px = 0.05}, 4);
  const auto of = [&](LensModel lens) {
    const auto fit = fit_camera({lens}, {640, 480}, simulated.shape, simulated.views, {});
    return residual_field(fit.value(), simulated.shape, 0);
  };
  EXPECT_FALSE(lens_fits(of(LensModel::Radial)));
  EXPECT_TRUE(lens_fits(of(LensModel::Fisheye)));
}

TEST(ResidualField, SaysNothingOfCellsWithFewCorners) {
  auto simulated = views_with_noise(0.2, 1);
  simulated.views[0].corners.resize(5);
  simulated.views[0].weights.resize(5);
  const ResidualField field = residual_field(at_truth(simulated), simulated.shape, 0);
  EXPECT_EQ(field.noise_px, 0);
  EXPECT_EQ(field.systematic_px, 0);
}

TEST(Coverage, IsTheShareOfCellsWithACorner) {
  ResidualField field;
  EXPECT_EQ(coverage(field), 0);
  field.cells.resize(8);
  field.cells[1].count = 3;
  field.cells[7].count = 1;
  EXPECT_EQ(coverage(field), 0.25);
}

}  // namespace
}  // namespace alidade
