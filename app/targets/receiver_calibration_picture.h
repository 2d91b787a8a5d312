// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include "app/targets/receiver_calibration_run.h"
#include "view/plot.h"
#include "view/scene.h"

namespace alidade {

/// Receivers where they were given (grey) and where they are, and the path. World z is up.
Scene scene_of(const ReceiverCalibrationRun& run);

/// Both coordinates of a camera's residuals over time; those far out are left off, and counted.
Plot residuals_over_time(const CalibratedReceiver& one);

/// A camera's residuals as arrows over its image, much enlarged (the scale is written); those far out are left off.
cv::Mat draw_residuals(const CalibratedReceiver& one);

}  // namespace alidade
