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

/// What a receiver reports of something that it saw, not knowing what: a pixel of a camera, or the azimuth and
/// elevation of a direction finder.
struct ReceiverReading {
  Timestamp time{};                                      ///< by the receiver's own clock; of a frame: its middle
  int receiver = 0;                                      ///< Receiver::id
  Eigen::Vector2d value = Eigen::Vector2d::Zero();       ///< (u, v) px, or (azimuth, elevation) rad
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of value, px² or rad²; zero: Receiver::sigma
  std::optional<double> temperature_k{};                 ///< what a radio-thermal receiver measured there
  int target = -1;                                       ///< which target it is of, where that is known; −1: not
};

/// A line of sight in the world: from where, in which direction and when a receiver saw something.
struct Bearing {
  Timestamp time{};                                            ///< by the receivers' common clock
  int receiver = 0;                                            ///< Receiver::id
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();      ///< m
  Eigen::Vector3d direction_world = Eigen::Vector3d::UnitZ();  ///< unit length
  /// Of the direction's error along the columns of tangent_basis(direction_world), rad²: the reading's own noise alone.
  Eigen::Matrix2d covariance = 1e-6 * Eigen::Matrix2d::Identity();
  std::optional<double> temperature_k{};
  int target = -1;  ///< which target it is of, where that is known; −1: not. No estimator reads it.
};

}  // namespace alidade
