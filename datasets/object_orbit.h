// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "geometry/pose.h"

namespace alidade {

/// Paths of a camera about a small object: those by which the camera tracker paper's experiments are re-created.
enum class OrbitPath {
  Smooth,     ///< distance first falling, then rising, by a sine
  Turn,       ///< the same by a hyperbola: uniform approach, a short turn, uniform retreat
  StopAndGo,  ///< Smooth in three legs, with a rest between them
};

/// T_world_camera of `frames` (>= 2) equally spaced times on the path, m; the object is 0.15 m large about the origin.
std::vector<Eigen::Isometry3d> orbit_poses(OrbitPath path, int frames);

/// 640×480, f = 426.7 px (24 mm on a 36 mm sensor), no distortion.
Camera orbit_camera();

/// An embossed egg of 453 points, always the same, m; for where the paper's bunny is not at hand.
std::vector<Eigen::Vector3d> orbit_object();

/// The points centred on their bounding box, whose longest side becomes `size_m`.
std::vector<Eigen::Vector3d> fitted_to(double size_m, std::vector<Eigen::Vector3d> points);

/// What the camera reports of exactly known points: a sighting of each with Gaussian noise of `sigma_px` per
/// coordinate; sigma_px of the observations is 1.
std::vector<PointObservation> sighted(const Camera& camera, const Eigen::Isometry3d& T_world_camera,
                                      std::span<const Eigen::Vector3d> points, double sigma_px,
                                      std::mt19937_64& random);

/// The observations with a share of them (each chosen on its own) anywhere in the image instead.
std::vector<PointObservation> with_outliers(const Camera& camera, std::vector<PointObservation> observations,
                                            double share, std::mt19937_64& random);

}  // namespace alidade
