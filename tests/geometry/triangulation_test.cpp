// SPDX-License-Identifier: Apache-2.0
#include "geometry/triangulation.h"

#include <numbers>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 11;
constexpr double kLeastAngle = 0.5 * std::numbers::pi / 180;

Ray ray_to(const Eigen::Vector3d& p, const Eigen::Vector3d& origin, double sigma_rad = 1e-3) {
  return {origin, (p - origin).normalized(), sigma_rad};
}

TEST(IntersectRays, MeetsWhereTheRaysMeet) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Vector3d p = random.vector(10.0);
    std::vector<Ray> rays;
    for (int i = 0; i < 2 + trial % 4; ++i) rays.push_back(ray_to(p, random.vector(10.0)));
    const auto found = intersect_rays(rays, kLeastAngle);
    ASSERT_TRUE(found) << trial;
    EXPECT_LT((found->p_world - p).norm(), 1e-10) << trial;
  }
}

// Two rays across each other at right angles, both at range 2 m with 1e-3 rad: along x only the second speaks, along y
// both do, along z only the first.
TEST(IntersectRays, HasTheCovarianceOfRangesTimesAngles) {
  const Eigen::Vector3d p(0, 0, 0);
  const std::vector<Ray> rays{ray_to(p, {-2, 0, 0}), ray_to(p, {0, 0, -2})};
  const auto found = intersect_rays(rays, kLeastAngle);
  ASSERT_TRUE(found);
  const double variance = 4e-6;  // (2 m × 1e-3 rad)²
  const Eigen::Matrix3d expected = Eigen::Vector3d(variance, variance / 2, variance).asDiagonal();
  EXPECT_LT((found->covariance_world - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(found->largest_angle_rad, std::numbers::pi / 2, 1e-12);
}

// The mean of eᵀP⁻¹e over n trials has mean 3 and variance 6/n; five sigma leave one false alarm in a million.
TEST(IntersectRays, HasErrorsAsLargeAsItsCovariance) {
  test::RandomGeometry random(kSeed);
  const Eigen::Vector3d p(0.3, -0.2, 5.0);
  const std::vector<Eigen::Vector3d> origins{{0, 0, 0}, {1, 0, 0}, {0.5, 0.8, -2.0}};
  const std::vector<double> sigmas{1e-3, 3e-3, 1e-3};
  constexpr int kTrials = 4000;
  double sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < origins.size(); ++i) {
      Ray ray = ray_to(p, origins[i], sigmas[i]);
      const Eigen::Vector3d across = random.vector(sigmas[i]);
      ray.direction_world = (ray.direction_world + across - across.dot(ray.direction_world) * ray.direction_world);
      ray.direction_world.normalize();
      rays.push_back(ray);
    }
    const auto found = intersect_rays(rays, kLeastAngle);
    ASSERT_TRUE(found);
    const Eigen::Vector3d error = found->p_world - p;
    sum += error.dot(found->covariance_world.ldlt().solve(error));
  }
  EXPECT_NEAR(sum / kTrials, 3.0, 5.0 * std::sqrt(6.0 / kTrials)) << "seed " << kSeed;
}

TEST(IntersectRays, TrustsThePreciseRaysMore) {
  const Eigen::Vector3d p(0, 0, 4);
  std::vector<Ray> rays{ray_to(p, {-1, 0, 0}), ray_to(p, {1, 0, 0}), ray_to({0, 0.1, 4}, {0, 0, 0})};
  rays[2].sigma_rad = 1.0;
  EXPECT_LT((intersect_rays(rays, kLeastAngle)->p_world - p).norm(), 1e-4);
  rays[2].sigma_rad = 1e-6;
  // It pulls the point off the others' plane, and a little along itself.
  EXPECT_GT(intersect_rays(rays, kLeastAngle)->p_world.y(), 0.09);
}

// At the solution the pulls of the rays, each weighed by its noise at the range to the solution itself, cancel. Ranges
// from 1 to 50 m: the weights of the first round, all alike, are far from it.
TEST(IntersectRays, SettlesTheWeightsAtTheSolution) {
  test::RandomGeometry random(kSeed);
  const Eigen::Vector3d p(0, 0, 0);
  std::vector<Ray> rays;
  for (double range : {1.0, 5.0, 20.0, 50.0}) {
    Ray ray = ray_to(p, range * random.direction(), 5e-3);
    ray.direction_world = exp_so3(random.vector(5e-3)) * ray.direction_world;
    rays.push_back(ray);
  }
  const auto found = intersect_rays(rays, kLeastAngle);
  ASSERT_TRUE(found);
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  for (const Ray& ray : rays) {
    const Eigen::Vector3d to_point = found->p_world - ray.origin_world;
    const Eigen::Vector3d across = to_point - to_point.dot(ray.direction_world) * ray.direction_world;
    pull += across / (ray.sigma_rad * ray.sigma_rad * to_point.squaredNorm());
  }
  EXPECT_LT((found->covariance_world * pull).norm(), 1e-6) << "seed " << kSeed;
}

TEST(IntersectRays, IsEmptyBelowTwoRays) {
  EXPECT_FALSE(intersect_rays({}, kLeastAngle));
  EXPECT_FALSE(intersect_rays(std::vector<Ray>{ray_to({0, 0, 1}, {0, 0, 0})}, kLeastAngle));
}

TEST(IntersectRays, IsEmptyBelowTheParallelThreshold) {
  const Eigen::Vector3d p(0, 0, 100);
  const std::vector<Ray> rays{ray_to(p, {0, 0, 0}), ray_to(p, {1, 0, 0})};  // 0.57 degrees
  EXPECT_TRUE(intersect_rays(rays, 0.5 * std::numbers::pi / 180));
  EXPECT_FALSE(intersect_rays(rays, 0.6 * std::numbers::pi / 180));
  EXPECT_FALSE(intersect_rays(std::vector<Ray>(2, rays[0]), 0.0));
}

TEST(IntersectRays, IsEmptyWhereTwoSensorsLookAtEachOther) {
  const Eigen::Vector3d p(0, 0, 1);
  EXPECT_FALSE(intersect_rays(std::vector<Ray>{ray_to(p, {0, 0, 0}), ray_to(p, {0, 0, 2})}, kLeastAngle));
}

TEST(IntersectRays, IsEmptyBehindASensor) {
  const Eigen::Vector3d p(0, 0, -3);
  std::vector<Ray> rays{ray_to(p, {-1, 0, 0}), ray_to(p, {1, 0, 0})};
  for (Ray& ray : rays) ray.direction_world = -ray.direction_world;
  EXPECT_FALSE(intersect_rays(rays, kLeastAngle));
}

TEST(IntersectRays, RefusesWhatIsNoDirectionAndNoSigma) {
  std::vector<Ray> rays{ray_to({0, 0, 1}, {0, 0, 0}), ray_to({0, 0, 1}, {1, 0, 0})};
  rays[1].direction_world *= 1.1;
  EXPECT_THROW(intersect_rays(rays, kLeastAngle), std::invalid_argument);
  rays[1].direction_world.x() = std::nan("");
  EXPECT_THROW(intersect_rays(rays, kLeastAngle), std::invalid_argument);
  rays[1] = ray_to({0, 0, 1}, {1, 0, 0}, 0.0);
  EXPECT_THROW(intersect_rays(rays, kLeastAngle), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
