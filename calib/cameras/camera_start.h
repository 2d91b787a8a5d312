// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "calib/bundle/board_bundle.h"
#include "calib/cameras/lens_model.h"

namespace alidade {

struct ImageExtent {
  int width = 0, height = 0;  ///< px
};

/// One camera and its boards near enough to the optimum for fit_bundle: Zhang's focal length and a range of others are
/// tried, the best one refined. Views are of camera 0, their frames number them from 0; a view whose board has no pose
/// gets weight 0. Empty where no focal length places the board in two views.
struct CameraStart {
  BoardBundle bundle;
  std::vector<BundleView> views;
};
std::optional<CameraStart> start_camera_bundle(LensModel lens, const ImageExtent& image, const BoardShape& shape,
                                               std::vector<BundleView> views);

}  // namespace alidade
