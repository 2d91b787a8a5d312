// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "camera/camera.h"
#include "view/scene.h"

namespace alidade {

/// From where a scene is looked at.
struct Viewpoint {
  Eigen::Vector3d eye_world = {0, 0, -1};
  Eigen::Vector3d target_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d up_world = -Eigen::Vector3d::UnitY();  ///< need not be perpendicular to the line of sight
  double vertical_fov_rad = 0.55;
};

/// A direction to look from, relative to the scene's own axes: up is what the cameras take for up, ahead where they
/// look to.
struct ViewAngles {
  double azimuth_rad = 0.6;    ///< round up; 0: from behind the cameras, positive: from their right
  double elevation_rad = 0.5;  ///< above the horizon
  double distance = 1.0;       ///< as a multiple of the one that fits the scene into the picture
};

/// The viewpoint from which the scene fills a picture of the given aspect ratio (width/height). Cameras, paths and
/// surfaces are all in it; of the points those within the 3rd to 97th percentile in each direction, so that a few wild
/// ones do not shrink the picture. An empty scene is looked at from (0, 0, -1).
Viewpoint frame_scene(const Scene& scene, const ViewAngles& angles = {}, double aspect = 1.5);

/// The eye carried round the target about up by `angle_rad`: a turntable.
Viewpoint turned(const Viewpoint& viewpoint, double angle_rad);

/// The pinhole camera of a picture of `size` px, and where it stands. A line of sight along up, or of no length, is
/// given some direction.
Camera camera_of(const Viewpoint& viewpoint, cv::Size size);
Eigen::Isometry3d T_world_camera_of(const Viewpoint& viewpoint);

}  // namespace alidade
