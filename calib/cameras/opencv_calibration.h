// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "calib/boards/board_view.h"
#include "calib/bundle/board_bundle.h"
#include "calib/cameras/camera_start.h"

namespace alidade {

/// What most people would get from the same corners.
struct OpencvCalibration {
  Camera camera;
  double rms_px = 0;  ///< of the residuals' length
};

/// cv::calibrateCamera with k1 k2 p1 p2 k3, to compare with. Empty where it fails.
std::optional<OpencvCalibration> calibrate_by_opencv(const ImageExtent& image, const BoardShape& shape,
                                                     std::span<const BoardView> views);

}  // namespace alidade
