// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/map_point.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "geometry/rotation.h"

namespace alidade {
namespace {

struct Linearised {
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 3> J_X;
  Eigen::Matrix2d R_inverse;
};

std::optional<Linearised> linearise(const Camera& camera, const PosedSighting& s, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p_camera = s.T_world_camera.inverse() * p_world;
  const auto projection = project(camera, p_camera);
  if (!projection) return std::nullopt;
  Eigen::Matrix<double, 2, 6> J_T;
  J_T << -projection->J_pixel_point, projection->J_pixel_point * skew(p_camera);
  const Eigen::Matrix2d R =
      s.sigma_px * s.sigma_px * Eigen::Matrix2d::Identity() + J_T * s.pose_covariance * J_T.transpose();
  return Linearised{s.pixel - projection->pixel, projection->J_pixel_point * s.T_world_camera.linear().transpose(),
                    R.inverse()};
}

std::optional<Intersection> start(const Camera& camera, std::span<const PosedSighting> sightings,
                                  double least_angle_deg) {
  std::vector<Ray> rays;
  for (const PosedSighting& s : sightings) {
    const auto d_camera = unproject(camera, s.pixel);
    if (!d_camera) return std::nullopt;
    rays.push_back(
        {s.T_world_camera.translation(), (s.T_world_camera.linear() * *d_camera).normalized(), s.sigma_px / camera.fx});
  }
  return intersect_rays(rays, least_angle_deg * std::numbers::pi / 180.0);
}

}  // namespace

std::optional<Intersection> triangulate(const Camera& camera, std::span<const PosedSighting> sightings,
                                        const MapPointOptions& options) {
  auto point = start(camera, sightings, options.least_angle_deg);
  if (!point) return std::nullopt;
  Eigen::Matrix3d A;
  for (int step = 0; step < 5; ++step) {
    A.setZero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const PosedSighting& s : sightings) {
      const auto l = linearise(camera, s, point->p_world);
      if (!l) return std::nullopt;
      A += l->J_X.transpose() * l->R_inverse * l->J_X;
      b += l->J_X.transpose() * l->R_inverse * l->residual;
    }
    const Eigen::Vector3d delta = A.ldlt().solve(b);
    if (!delta.allFinite()) return std::nullopt;
    point->p_world += delta;
    if (delta.dot(A * delta) < 1e-8) break;
  }
  double worst = 0;
  for (const PosedSighting& s : sightings) {
    const auto l = linearise(camera, s, point->p_world);
    if (!l) return std::nullopt;
    worst = std::max(worst, l->residual.dot(l->R_inverse * l->residual));
  }
  if (worst > options.gate_chi2) return std::nullopt;
  point->covariance_world = A.ldlt().solve(Eigen::Matrix3d::Identity());
  if (!point->covariance_world.allFinite()) return std::nullopt;
  return point;
}

}  // namespace alidade
