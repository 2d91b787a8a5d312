// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "camera/camera.h"
#include "tracking/frame.h"
#include "tracking/live_map.h"
#include "tracking/map_growth.h"

namespace alidade {

/// An image whose pose is known, with its depth where it was measured.
struct PosedImage {
  ImageFrame frame;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Vector6d twist = Vector6d::Zero();  ///< how the camera moves, m/s and rad/s along its axes: for a rolling shutter
  cv::Mat depth;                      ///< 16-bit, along the optical axis, 0 where unknown; may be empty
  double depth_unit_m = 1.0;          ///< metres per step of `depth`
  double depth_delay_s = 0.0;         ///< when it was taken, after the image
};

struct PosedMapOptions {
  SiftOptions sift;
  GrowthOptions growth;
  double pose_sigma_m = 0.005;  ///< of the given poses: how far around its projection a point is looked for
  double pose_sigma_rad = 0.003;
  double depth_sigma_at_1m = 0.0028;  ///< m; grows with the square of the distance (structured light, Khoshelham 2012)
  double most_depth_m = 6.0;          ///< beyond it such a sensor is not believed
  double most_depth_step_share = 0.03;  ///< of the depth, within two pixels: beyond it the feature lies on an edge
};

/// The map with one more image: known points found again in it, new ones lifted by its depth, or triangulated with
/// earlier images where there is none. The pose stays as given.
LiveMap with_posed_image(const Camera& camera, LiveMap live, const PosedImage& image, const PosedMapOptions& options);

}  // namespace alidade
