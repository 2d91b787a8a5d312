// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/map_point.h"

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 31;
const Eigen::Vector3d kPoint(0.4, -0.6, 0.3);

std::vector<PosedSighting> see(const Camera& camera, const Eigen::Vector3d& p_world, int cameras) {
  std::vector<PosedSighting> sightings;
  for (int k = 0; k < cameras; ++k) {
    PosedSighting s;
    s.T_world_camera = test::looking_at({6 * std::cos(0.2 * k), 6 * std::sin(0.2 * k), 0.5}, {0, 0, 0});
    s.pixel = project(camera, s.T_world_camera.inverse() * p_world)->pixel;
    sightings.push_back(s);
  }
  return sightings;
}

TEST(TriangulateMapPoint, IsExactOnExactSightings) {
  const Camera camera = test::vga_camera();
  for (int cameras : {2, 3, 5}) {
    const auto point = triangulate(camera, see(camera, kPoint, cameras));
    ASSERT_TRUE(point);
    EXPECT_LT((point->p_world - kPoint).norm(), 1e-8);
    EXPECT_NEAR(point->largest_angle_rad, 0.2 * (cameras - 1), 0.05);
  }
}

// Pixels and poses drawn from what triangulate is told. The mean over 1000 trials has mean 3 and variance 6/1000.
TEST(TriangulateMapPoint, HasErrorsAsLargeAsItsCovariance) {
  const Camera camera = test::vga_camera();
  test::RandomGeometry random(kSeed);
  Vector6d sigmas;
  sigmas << 0.01, 0.02, 0.01, 0.002, 0.001, 0.002;
  const auto exact = see(camera, kPoint, 3);
  MapPointOptions options;
  options.gate_chi2 = 50;
  constexpr int kTrials = 1000;
  double sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto sightings = exact;
    for (PosedSighting& s : sightings) {
      s.sigma_px = 0.7;
      s.pixel += Eigen::Vector2d(random.normal(0.7), random.normal(0.7));
      s.pose_covariance = sigmas.cwiseAbs2().asDiagonal();
      Vector6d xi;
      xi << random.vector(), random.vector();
      s.T_world_camera = s.T_world_camera * perturbation(sigmas.cwiseProduct(xi));
    }
    const auto point = triangulate(camera, sightings, options);
    ASSERT_TRUE(point) << trial;
    const Eigen::Vector3d error = point->p_world - kPoint;
    sum += error.dot(point->covariance_world.ldlt().solve(error));
  }
  EXPECT_NEAR(sum / kTrials, 3.0, 3.3 * std::sqrt(6.0 / kTrials)) << "seed " << kSeed;
}

TEST(TriangulateMapPoint, IsEmptyWhereTheRaysAreTooParallel) {
  const Camera camera = test::vga_camera();
  const auto sightings = see(camera, kPoint, 2);  // 11 degrees apart
  MapPointOptions options;
  options.least_angle_deg = 10;
  EXPECT_TRUE(triangulate(camera, sightings, options));
  options.least_angle_deg = 14;
  EXPECT_FALSE(triangulate(camera, sightings, options));
  EXPECT_FALSE(triangulate(camera, std::vector<PosedSighting>(3, sightings[0])));
  EXPECT_FALSE(triangulate(camera, std::vector<PosedSighting>{sightings[0]}));
  EXPECT_FALSE(triangulate(camera, {}));
}

TEST(TriangulateMapPoint, IsEmptyWhereASightingDisagrees) {
  const Camera camera = test::vga_camera();
  auto sightings = see(camera, kPoint, 4);
  sightings[2].pixel.y() += 6;
  EXPECT_FALSE(triangulate(camera, sightings));
  for (PosedSighting& s : sightings) s.sigma_px = 3;
  EXPECT_TRUE(triangulate(camera, sightings));
}

// Two cameras side by side whose rays part: they meet behind both.
TEST(TriangulateMapPoint, IsEmptyBehindTheCameras) {
  const Camera camera = test::vga_camera();
  std::vector<PosedSighting> sightings(2);
  sightings[1].T_world_camera.translation().x() = 1.0;
  sightings[0].pixel = {222, 238};
  sightings[1].pixel = {422, 238};
  EXPECT_FALSE(triangulate(camera, sightings));
  std::swap(sightings[0].pixel, sightings[1].pixel);
  EXPECT_TRUE(triangulate(camera, sightings));
}

}  // namespace
}  // namespace alidade
