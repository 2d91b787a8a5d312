// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/time.h"

namespace alidade {

/// A map point seen at a pixel: two planes through the camera's centre, and what is known of the point itself.
struct PointObservation {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();             ///< px, as detected (distorted)
  double sigma_px = 1.0;                                       ///< of each coordinate
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();           ///< m
  Eigen::Matrix3d covariance_world = Eigen::Matrix3d::Zero();  ///< of p_world, m²
  /// Whence the point was triangulated (m): its error is then Gaussian in direction and inverse distance from there.
  /// Empty: it is Gaussian in p_world.
  std::optional<Eigen::Vector3d> seen_from;
};

/// What one linear detector read of one marker.
struct LineReading {
  Timestamp time{};
  int detector = 0;    ///< LineDetector::id
  int marker = 0;      ///< BodyMarker::id, as far as the detector knows
  double value = 0.0;  ///< in the detector's unit (rad, px)
  double sigma = 0.0;  ///< its standard deviation; 0: LineDetector::sigma
};

}  // namespace alidade
