// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "camera/camera.h"
#include "geometry/plane.h"

namespace alidade {

// What a linear detector reads of a point in its own frame: one number. Each model is a family of planes, one per
// reading: all points that are read alike (exactly a plane without distortion, else to first order about a point).

/// Angle about the focal line, which is the frame's y axis: atan2(x, z), rad. The detector of the seed paper.
struct FocalLine {
  bool operator==(const FocalLine&) const = default;
};

/// Pixel on a line of pixels behind a cylindrical lens, whose focal line is the frame's y axis:
/// u = c + f q (1 + k1 q² + k2 q⁴ + k3 q⁶), q = x / z; px.
struct LineCamera {
  int width = 0;        ///< px
  double f = 0, c = 0;  ///< px
  double k1 = 0, k2 = 0, k3 = 0;
  bool operator==(const LineCamera&) const = default;
};

/// Factory terms of a laser sweep, rad. Which of them are used, and how, is the model's.
struct SweepTerms {
  double phase = 0, tilt = 0, curve = 0, gibmag = 0, gibphase = 0, ogeemag = 0, ogeephase = 0;
  bool operator==(const SweepTerms&) const = default;
};

/// SteamVR's first laser sweeps: planes through a focal line. Station frame: x forward, z up. Sweep 0 turns about z,
/// sweep 1 about y. Raw angle, rad.
struct Lighthouse1 {
  int sweep = 0;  ///< 0, 1
  SweepTerms terms;
  bool operator==(const Lighthouse1&) const = default;
};

/// The second generation: planes tilted by -30° (sweep 0) and +30° (sweep 1), which share the rotor's centre. Station
/// frame: x forward, z up. Raw angle, rad; curve and ogee are not used.
struct Lighthouse2 {
  int sweep = 0;
  SweepTerms terms;
  bool operator==(const Lighthouse2&) const = default;
};

/// The same with all factory terms, in libsurvive's station frame: looking along -z, y up. Raw angle, rad.
struct Lighthouse2Full {
  int sweep = 0;
  SweepTerms terms;
  bool operator==(const Lighthouse2Full&) const = default;
};

/// One coordinate of a camera's pixels, px: a calibrated camera is two line detectors.
struct PixelAxis {
  Camera camera;
  int axis = 0;  ///< 0: x, 1: y
  bool operator==(const PixelAxis&) const = default;
};

using LineModel = std::variant<FocalLine, LineCamera, Lighthouse1, Lighthouse2, Lighthouse2Full, PixelAxis>;

/// A linear detector: what it reads of a point, and where it stands. The detectors of one station share its frame.
struct LineDetector {
  int id = 0;           ///< by which readings name it
  std::string station;  ///< detectors of one station stand rigidly together, at one T_world_station
  LineModel model;
  Eigen::Isometry3d T_world_station = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_station_detector = Eigen::Isometry3d::Identity();
  double sigma = 1e-4;  ///< standard deviation of a reading, in its unit (rad, px)
};

/// A reading and how it moves with the point that is read.
struct LineProjection {
  double value = 0.0;                                             ///< rad or px
  Eigen::RowVector3d J_value_point = Eigen::RowVector3d::Zero();  ///< per m
};

/// What the model reads of a point in its own frame; empty where it does not see the point (behind it, or on its focal
/// line).
std::optional<LineProjection> project(const LineModel& model, const Eigen::Vector3d& p_detector);

/// The same for a point of the world.
std::optional<LineProjection> project(const LineDetector& detector, const Eigen::Vector3d& p_world);

/// The plane, in the world, in which a marker must lie that is read at `value`: the tangent, near `near_world`, of the
/// surface on which all points are read so; exact where the model's planes are. It passes through the detector's
/// centre. A value so far from what the point should give that the surface is not reached from there gives the plane of
/// the reading's first order about the point. Empty where the model does not see that point.
std::optional<Plane> plane_near(const LineDetector& detector, double value, const Eigen::Vector3d& near_world);

/// The same without a notion of where the marker is: the plane of the model's axis (elevation 0 of a laser sweep, the
/// optical axis of a lens), which is exact for a focal line and off by the factory terms (mrad) for others. Empty where
/// no point is read at `value`.
std::optional<Plane> plane_of(const LineDetector& detector, double value);

/// The reading of a plane of the world, the inverse of plane_of: that of the axis point that lies in the plane, whether
/// or not the plane passes through the detector's centre. Empty where no axis point in view does.
std::optional<double> value_of(const LineDetector& detector, const Plane& plane_world);

/// Whether the model reads pixels; else angles, rad.
bool reads_pixels(const LineModel& model);

/// value - expected, in the model's unit; angles that differ by whole turns are the same: theirs is in [-π, π].
double residual(const LineModel& model, double value, double expected);

/// Where all planes of the detector meet (focal line's point, rotor, lens), in the world: ranges count from here.
Eigen::Vector3d centre_world(const LineDetector& detector);

}  // namespace alidade
