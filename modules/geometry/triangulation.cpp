// SPDX-License-Identifier: Apache-2.0
#include "geometry/triangulation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace alidade {
namespace {

void require_valid(std::span<const Ray> rays) {
  for (const Ray& ray : rays) {
    if (!(std::abs(ray.direction_world.norm() - 1.0) <= 1e-6)) {
      throw std::invalid_argument("intersect_rays: a direction is not of unit length");
    }
    if (!(ray.sigma_rad > 0)) throw std::invalid_argument("intersect_rays: sigma_rad must be > 0");
  }
}

double largest_angle(std::span<const Ray> rays) {
  double largest = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t j = i + 1; j < rays.size(); ++j) {
      const Eigen::Vector3d& a = rays[i].direction_world;
      const Eigen::Vector3d& b = rays[j].direction_world;
      // Two rays that look at each other along one line fix no point on it: the angle is that of the lines.
      largest = std::max(largest, std::atan2(a.cross(b).norm(), std::abs(a.dot(b))));
    }
  }
  return largest;
}

struct NormalEquations {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
};

// Each ray constrains the two directions across it; `range` turns its angular noise into a distance.
template <typename RangeOf>
NormalEquations accumulate(std::span<const Ray> rays, RangeOf range_of) {
  NormalEquations sum;
  for (const Ray& ray : rays) {
    const Eigen::Vector3d& d = ray.direction_world;
    const double sigma_m = ray.sigma_rad * range_of(ray);
    const Eigen::Matrix3d W = (Eigen::Matrix3d::Identity() - d * d.transpose()) / (sigma_m * sigma_m);
    sum.A += W;
    sum.b += W * ray.origin_world;
  }
  return sum;
}

}  // namespace

std::optional<Intersection> intersect_rays(std::span<const Ray> rays, double least_angle_rad) {
  require_valid(rays);
  if (rays.size() < 2) return std::nullopt;
  Intersection result;
  result.largest_angle_rad = largest_angle(rays);
  if (!(result.largest_angle_rad > least_angle_rad)) return std::nullopt;

  NormalEquations sum = accumulate(rays, [](const Ray&) { return 1.0; });
  result.p_world = sum.A.ldlt().solve(sum.b);
  // The distance across a ray over its range is the sine of the angle off it; three rounds settle the ranges.
  for (int round = 0; round < 3; ++round) {
    const Eigen::Vector3d p = result.p_world;
    sum = accumulate(rays, [&](const Ray& ray) { return std::max(1e-12, (p - ray.origin_world).norm()); });
    result.p_world = sum.A.ldlt().solve(sum.b);
  }
  for (const Ray& ray : rays) {
    if ((result.p_world - ray.origin_world).dot(ray.direction_world) <= 0) return std::nullopt;
  }
  result.covariance_world = sum.A.ldlt().solve(Eigen::Matrix3d::Identity());
  if (!result.p_world.allFinite() || !result.covariance_world.allFinite()) return std::nullopt;
  return result;
}

}  // namespace alidade
