// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace alidade {

/// A line of sight: a half-line from a sensor's centre, with its angular standard deviation (isotropic).
struct Ray {
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_world = Eigen::Vector3d::UnitZ();  ///< unit length
  double sigma_rad = 1e-3;
};

/// Where rays meet, and how surely.
struct Intersection {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_world = Eigen::Matrix3d::Zero();  ///< m²
  double largest_angle_rad = 0.0;                              ///< between the lines of any two rays, [0, π/2]
};

/// The point with the least squared distance across all rays, each distance weighed by its noise at the point's range
/// (to first order in the noise the most probable point), and its covariance from the rays' angular noise. Empty below
/// two rays, where the lines of no two of them differ by `least_angle_rad`, or where the point lies behind a ray's
/// origin.
/// Throws std::invalid_argument for a direction that is not of unit length or a sigma that is not positive.
std::optional<Intersection> intersect_rays(std::span<const Ray> rays, double least_angle_rad);

}  // namespace alidade
