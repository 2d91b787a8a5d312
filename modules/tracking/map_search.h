// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "features/matching.h"
#include "geometry/point_map.h"

namespace alidade {

/// A map point found in an image.
struct FoundPoint {
  int point = -1;    ///< index into PointMap::points
  int feature = -1;  ///< index into the image's features; -1: found by optical flow
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// Where a camera is believed to be, for a search.
struct PoseBelief {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of the right perturbation
};

/// Where a point is expected: its pixel and the innovation covariance J P Jᵀ + R (px²).
struct ExpectedPixel {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d S = Eigen::Matrix2d::Identity();
};

struct SearchOptions {
  double sigma_px = 1.0;     ///< measurement noise
  double gate_sigmas = 3.5;  ///< half size of the innovation ellipse that is searched
  double least_radius_px = 3.0;
  double most_radius_px = 60.0;
  GuidedOptions descriptor;
};

/// Where a map point will appear, and how surely; empty where it is behind the camera or outside the image.
std::optional<ExpectedPixel> expect(const Camera& camera, const PoseBelief& belief, const MapPoint& point,
                                    double sigma_px);

/// Looks for each of `candidates` (indices of map points) among the features inside its innovation ellipse; a feature
/// already `taken` is passed over, and of several points on one feature the one with the nearest descriptor gets it.
std::vector<FoundPoint> search_points(const Camera& camera, const PointMap& map, const std::vector<int>& candidates,
                                      const PoseBelief& belief, const Features& features,
                                      const std::vector<bool>& taken, const SearchOptions& options);

/// Matches map points to an image's features by descriptor alone.
std::vector<FoundPoint> match_points(const PointMap& map, const std::vector<int>& candidates, const Features& features,
                                     double ratio);

/// A map point seen at a pixel, for an estimator.
PointObservation as_observation(const MapPoint& point, const Eigen::Vector2d& pixel, double sigma_px);

/// What the found points say to an estimator.
std::vector<PointObservation> as_observations(const PointMap& map, const std::vector<FoundPoint>& found,
                                              double sigma_px);

}  // namespace alidade
