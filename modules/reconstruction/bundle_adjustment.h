// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera/camera.h"
#include "geometry/point_map.h"

namespace alidade {

struct BundleOptions {
  std::vector<int> free_keyframes;   ///< whose poses move; indices into PointMap::keyframes
  std::vector<int> fixed_keyframes;  ///< which hold the points as they stand; none: the scale is free, kept by damping
  double loss_sigmas = 2.0;          ///< Cauchy scale: a residual beyond it pulls ever less
  int max_iterations = 20;
  bool refine_focal = false;  ///< one factor on fx and fy, to see which focal length fits
};

struct BundleResult {
  PointMap map;
  double rms_px_before = 0;  ///< of the residual vectors' length, all sightings that took part
  double rms_px_after = 0;
  int sighting_count = 0;
  int iterations = 0;
  double seconds = 0;
  bool converged = false;
  double focal_factor = 1.0;  ///< with refine_focal: what fx and fy have to be multiplied with
  double focal_factor_sigma =
      0.0;  ///< its standard deviation, from the gain in cost (the map must have converged before)
};

/// Moves the free keyframes and every point that they see to the least robust reprojection error over the sightings of
/// all given keyframes; points with fewer than two such sightings stay. Deterministic (one thread).
/// Throws std::invalid_argument for indices out of range. Ceres, Schur complement, analytic Jacobians.
BundleResult adjust_bundle(const Camera& camera, PointMap map, const BundleOptions& options);

/// All keyframes but the first few (`fixed_count`) free.
BundleOptions global_bundle_options(const PointMap& map, int fixed_count);

struct SightingCut {
  PointMap map;
  int removed = 0;
};

/// Removes sightings that lie behind their camera or whose residual exceeds `most_sigmas`, then every point's sightings
/// where fewer than two are left.
SightingCut remove_outlying_sightings(const Camera& camera, PointMap map, double most_sigmas);

/// The standard deviation of one coordinate of the residuals in units of the sightings' sigma_px, from their median
/// length: outliers do not raise it. 1 for a map without sightings.
double reprojection_sigma(const Camera& camera, const PointMap& map);

/// Root mean square length of the residuals of all sightings, px; 0 for a map without any.
double reprojection_rms_px(const Camera& camera, const PointMap& map);

}  // namespace alidade
