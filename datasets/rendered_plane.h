// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "camera/camera.h"

namespace alidade {

/// A picture on a plane, such as a calibration board's. The plane's frame: x and y along the picture's rows and
/// columns, z = 0; a point (x, y) m is at pixel origin_px + pixels_per_m (x, y).
struct PlaneTexture {
  cv::Mat grey;  ///< CV_8UC1
  double pixels_per_m = 1000;
  Eigen::Vector2d origin_px = Eigen::Vector2d::Zero();
};

/// How a plane that should be flat bulges: z = height_m.x (1 − u²) + height_m.y (1 − v²) with (u, v) the distance from
/// the centre in half sizes, as mrcal models a board (https://mrcal.secretsauce.net/formulation.html).
struct PlaneBulge {
  Eigen::Vector2d height_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_size_m = Eigen::Vector2d::Ones();
};

/// z of the bulging plane at p_plane = (x, y), m.
double height_m(const PlaneBulge& bulge, const Eigen::Vector2d& p_plane);

/// Options of a picture of a plane.
struct PlaneRenderOptions {
  double blur_px = 0;            ///< standard deviation of the lens' blur, beyond that of the pixels themselves
  double noise_grey = 0;         ///< standard deviation of the Gaussian pixel noise, grey levels
  int supersampling = 2;         ///< rays per side of a pixel; edges lie within 0.01 px from 2 on
  double background_grey = 160;  ///< of all that is not the picture
  unsigned seed = 1;             ///< of the noise
  PlaneBulge bulge;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const PlaneRenderOptions& options);

/// Draws a picture on a plane as cameras of any lens model see it: each ray through a pixel meets the plane at one
/// point by the camera's own unproject. Rays are computed on a lattice of 8 px and interpolated by cubics (to 0.001
/// px).
class PlaneRenderer {
 public:
  /// Throws std::invalid_argument for a camera with a fault, and a texture that is empty, not grey or without scale.
  PlaneRenderer(const Camera& camera, const PlaneTexture& texture);

  /// The image, CV_8UC1. The plane may be seen from either side and be partly behind the camera. The same options give
  /// the same bytes. Throws as validate does.
  cv::Mat render(const Eigen::Isometry3d& T_camera_plane, const PlaneRenderOptions& options = {}) const;

 private:
  Camera camera_;
  std::vector<cv::Mat> levels_;  // the texture, each level half as large as the one before
  double pixels_per_m_;
  Eigen::Vector2d origin_px_;
  int nodes_x_, nodes_y_;
  std::vector<Eigen::Vector3d> d_camera_;  // of the lattice's nodes; NaN where the lens has no ray
};

/// One image, as PlaneRenderer draws it.
cv::Mat render_plane(const Camera& camera, const Eigen::Isometry3d& T_camera_plane, const PlaneTexture& texture,
                     const PlaneRenderOptions& options = {});

}  // namespace alidade
