// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/time.h"
#include "geometry/pose.h"

namespace alidade {

/// A SIFT descriptor as bytes; all zero where the point has none.
using Descriptor = std::array<std::uint8_t, 128>;

/// A point of the scene.
struct MapPoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_world = Eigen::Matrix3d::Zero();  ///< m²
  std::array<std::uint8_t, 3> rgb{128, 128, 128};
  Descriptor descriptor{};
};

/// One keyframe's sighting of a map point.
struct Sighting {
  int point = -1;                                   ///< index into PointMap::points
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< px, as detected (distorted)
  double sigma_px = 1.0;                            ///< of each coordinate
};

/// An image whose sightings support the map.
struct Keyframe {
  int frame = 0;  ///< index of the image in its source
  Timestamp time{};
  std::string image;  ///< file name in its source, or empty
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of the right perturbation (translation, rotation); m, rad
  std::vector<Sighting> sightings;
};

/// A map to see, to save and to track in. The world's unit of length is metres where the scale is known.
struct PointMap {
  std::vector<MapPoint> points;
  std::vector<Keyframe> keyframes;
};

}  // namespace alidade
