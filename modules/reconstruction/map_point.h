// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "camera/camera.h"
#include "geometry/pose.h"
#include "geometry/triangulation.h"

namespace alidade {

/// A point's sighting from a posed camera.
struct PosedSighting {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Matrix6d pose_covariance = Matrix6d::Zero();  ///< of the right perturbation, m and rad
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;
};

struct MapPointOptions {
  double least_angle_deg = 1.0;  ///< between two of the rays
  double gate_chi2 = 9.2;        ///< the worst sighting's squared whitened residual (99 %, 2 degrees of freedom)
};

/// The point seen by all sightings, by Gauss–Newton on the reprojection error, each weighed by its pixel noise and its
/// pose's covariance, R = σ²I + J_T P_T J_Tᵀ; with its covariance. Empty where the rays are too parallel, the point
/// lies behind a camera or a sighting disagrees beyond the gate.
std::optional<Intersection> triangulate(const Camera& camera, std::span<const PosedSighting> sightings,
                                        const MapPointOptions& options = {});

}  // namespace alidade
