// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "datasets/procedural_texture.h"
#include "view/scene.h"

namespace alidade {

/// A rectangle in space, seen from its front: `across` points right, `down` points down, both with their lengths (m).
struct Panel {
  Eigen::Vector3d corner_world;  ///< top left
  Eigen::Vector3d across_world;
  Eigen::Vector3d down_world;
};

/// A panel with a relief: at each point (u, v), 0..1 across and down, `height_m` towards the viewer. Textured with
/// leaves; the texture's size is the panel's. `cells`: of the mesh, across and down, at least 1 × 1.
TexturedSurface make_relief(const Panel& panel, const std::function<double(double, double)>& height_m,
                            const Eigen::Vector2i& cells, LeafTextureOptions texture);

/// A flat panel with a picture (CV_8UC3) on all of it.
TexturedSurface make_poster(const Panel& panel, const cv::Mat& picture);

/// A box with edges `size_m`, centred at T_world_box's origin, each face with its own part of a texture of leaves and
/// its own brightness.
TexturedSurface make_box(const Eigen::Isometry3d& T_world_box, const Eigen::Vector3d& size_m,
                         LeafTextureOptions texture);

/// A ball with a texture of leaves.
TexturedSurface make_ball(const Eigen::Vector3d& centre_world, double radius_m, LeafTextureOptions texture);

}  // namespace alidade
