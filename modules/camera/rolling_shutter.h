// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "camera/camera.h"
#include "geometry/pose.h"

namespace alidade {

/// When the row of a pixel is exposed, in s after the middle row, whose moment is the image's time.
double row_time_s(const Camera& camera, double y_px);

/// The pixel at which a rolling shutter's camera would have seen a point, had all rows been exposed with the middle
/// one. `twist` is how the camera moves (m/s and rad/s along its own axes), `depth_m` the point's in its row's view;
/// left out, the point counts as far away and the camera's turning alone is taken out. The pixel itself where the point
/// would not have been seen.
Eigen::Vector2d at_middle_row(const Camera& camera, const Eigen::Vector2d& pixel, const Vector6d& twist,
                              double depth_m = std::numeric_limits<double>::infinity());

}  // namespace alidade
