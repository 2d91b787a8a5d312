// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "geometry/pose.h"

namespace alidade {

/// A receiver's clock against the common one: common = own + offset + rate · (own − reference).
struct ReceiverClock {
  double offset_s = 0.0;                                 ///< at the reference
  double rate = 0.0;                                     ///< s/s; 1e-6: one part per million
  Timestamp reference{};                                 ///< by the receiver's own clock
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (offset_s, rate)
};

/// The moment of the common clock at which the receiver's own clock shows `own`, and the reverse.
Timestamp common_time(const ReceiverClock& clock, Timestamp own);
Timestamp own_time(const ReceiverClock& clock, Timestamp common);

/// Which way the y axis of a direction finder points; its x-z plane is level where it stands upright.
enum class FinderAxes {
  YDown,  ///< x right, y down, z forward, as a camera's
  YUp,    ///< x left, y up, z forward, as the UAV paper's
};

/// What watches the sky from a known place: a camera, or a direction finder that reports azimuth and elevation. Azimuth
/// is counted from z towards x, elevation from the x-z plane upwards. Its id is unique among receivers.
struct Receiver {
  int id = 0;
  std::string name;
  std::optional<Camera> camera;         ///< empty: a direction finder. Camera::readout_s is its rolling shutter
  FinderAxes axes = FinderAxes::YDown;  ///< of a direction finder
  Eigen::Isometry3d T_world_receiver = Eigen::Isometry3d::Identity();
  std::optional<Matrix6d> pose_covariance{};  ///< of its right perturbation xi = (translation, rotation); m, rad
  ReceiverClock clock;
  double sigma = 1.0;  ///< of each coordinate of a pixel, px; of a direction finder: across the line of sight, rad
};

/// Says what is impossible about a receiver ("sigma must be > 0 px, got -1"); empty where nothing is.
std::optional<std::string> find_fault(const Receiver& receiver);

/// The unit direction of azimuth and elevation (rad) in the receiver's axes, and the reverse, azimuth in (−π, π].
/// Source: UAV paper eqs. 2 and 3.
Eigen::Vector3d direction_of_angles(const Eigen::Vector2d& azimuth_elevation, FinderAxes axes = FinderAxes::YDown);
Eigen::Vector2d angles_of_direction(const Eigen::Vector3d& d_receiver, FinderAxes axes = FinderAxes::YDown);

/// The line of sight of a reading: direction by the camera's model or the angles, time by the receiver's clock and, of
/// a rolling shutter, the pixel's row; covariance from the reading's, or from Receiver::sigma. Empty where a lens's
/// distortion has no inverse at the pixel. Throws std::invalid_argument for a reading of another receiver.
/// Source: UAV paper eq. 1 (pixels) and 2 (angles).
std::optional<Bearing> bearing_of(const Receiver& receiver, const ReceiverReading& reading);

/// The bearings of readings by any of the receivers, in order of time; those without a direction are left out. Throws
/// std::invalid_argument for a reading of a receiver that is not there.
std::vector<Bearing> bearings_of(std::span<const Receiver> receivers, std::span<const ReceiverReading> readings);

/// The reading without noise that a receiver makes of a point (m) that is at p_world when it looks, at `common` time;
/// a camera with a rolling shutter is told the middle row's time. Empty where a camera does not see it.
std::optional<ReceiverReading> reading_of(const Receiver& receiver, const Eigen::Vector3d& p_world, Timestamp common);

}  // namespace alidade
