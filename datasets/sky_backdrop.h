// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "camera/camera.h"
#include "core/time.h"

namespace alidade {

/// Options of what a camera sees behind flying objects; world z is up. Grey levels of 0 to 255.
struct SkyBackdropOptions {
  double horizon_grey = 190.0;    ///< of the clear sky just above the skyline
  double zenith_grey = 130.0;     ///< and overhead
  double cloud_grey = 45.0;       ///< how much brighter the middle of a cloud is
  double cloud_texture = 12.0;    ///< standard deviation of the fractal texture within clouds
  double cloud_cover = 0.5;       ///< share of the sky, 0 to 1
  double wind_rad_s = 0.01;       ///< how fast clouds overhead drift: 10 m/s at 1000 m. Two layers, one half as fast
  double wind_azimuth_rad = 0.6;  ///< whither, from world x towards y
  double ground_grey = 85.0;      ///< mean of the ground's figures
  double skyline_rad = 0.02;      ///< mean elevation of hills and trees
  unsigned seed = 1;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const SkyBackdropOptions& options);

/// Sky with drifting clouds above textured ground, as a camera that stands still sees it. Directions alone matter: all
/// of it is far away.
class SkyBackdrop {
 public:
  /// The picture reaches `margin_px` beyond the image on each side. Throws std::invalid_argument for a camera with a
  /// fault, and as validate does.
  SkyBackdrop(const Camera& camera, const Eigen::Isometry3d& T_world_camera, int margin_px,
              const SkyBackdropOptions& options = {});

  /// The picture at a moment of the common clock: CV_32FC1, grey levels, (width + 2 margin) × (height + 2 margin) px.
  /// The same options give the same picture.
  cv::Mat picture(Timestamp common) const;

 private:
  cv::Mat clouds(double drift, const cv::Mat& texture) const;

  SkyBackdropOptions options_;
  cv::Mat still_;                       // clear sky and ground
  cv::Mat openness_;                    // how much of the clouds shows: 0 on the ground, less at the horizon
  cv::Mat cloud_x_, cloud_y_;           // where each pixel meets the layer of clouds, texels
  cv::Mat near_texture_, far_texture_;  // fractal, mean 0, standard deviation 1, periodic
};

}  // namespace alidade
