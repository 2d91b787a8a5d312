// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "camera/line_detector.h"
#include "camera/measurement.h"
#include "geometry/plane.h"
#include "geometry/rigid_body.h"

namespace alidade {

/// A plane of the world in which a marker of a body was seen.
struct MarkerPlane {
  int marker = 0;  ///< index into RigidBody::markers
  Plane plane_world;
  double weight = 1.0;  ///< 1 / σ², σ the standard deviation of the marker's distance from the plane, in m
};

/// The plane of a reading about a point near the marker (exact for a focal line, to first order for others), with
/// σ = σ_reading / |∂reading/∂point|: angle times range. MarkerPlane::marker is left 0. Empty where the detector does
/// not see the point. Throws std::invalid_argument for a reading without any sigma.
std::optional<MarkerPlane> plane_about(const LineDetector& detector, const LineReading& reading,
                                       const Eigen::Vector3d& p_world);

/// The planes of the readings that are of the body's markers, in their order; readings of other markers, and of markers
/// that their detector cannot see there, are left out. With a predicted pose the planes are those about the predicted
/// markers (plane_about). Without, they are of the detector's axis, and σ is that at a range of 1 m (rad) or unknown
/// (px): the same for all of one detector. Throws std::invalid_argument for a reading by a detector that is not there
/// or without any sigma.
std::vector<MarkerPlane> marker_planes(std::span<const LineDetector> detectors, const RigidBody& body,
                                       std::span<const LineReading> readings,
                                       const std::optional<Eigen::Isometry3d>& T_world_body_predicted);

}  // namespace alidade
