// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "geometry/point_map.h"
#include "tests/geometry/random_geometry.h"

namespace alidade::test {

/// A VGA camera with the distortion of a cheap lens.
Camera vga_camera();

/// The pose of a camera at `eye` whose axis goes through `target`, its y axis as near to world -z as can be.
Eigen::Isometry3d looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// Sightings of all points that are visible from a pose, with noise of `noise_px` on each coordinate.
std::vector<Sighting> sightings_from(const Camera& camera, const std::vector<MapPoint>& points,
                                     const Eigen::Isometry3d& T_world_camera, double noise_px, RandomGeometry& random);

/// `count` points in a box of 4 m about the origin, seen by `keyframes` cameras on an arc of 6 m radius.
PointMap make_map(const Camera& camera, int count, int keyframes, double noise_px, RandomGeometry& random);

/// What a keyframe sees, for an estimator of its pose.
std::vector<PointObservation> observations_of(const PointMap& map, std::size_t keyframe);

}  // namespace alidade::test
