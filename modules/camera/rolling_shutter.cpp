// SPDX-License-Identifier: Apache-2.0
#include "camera/rolling_shutter.h"

#include <cmath>

namespace alidade {

double row_time_s(const Camera& camera, double y_px) {
  return camera.readout_s * ((y_px + 0.5) / camera.height - 0.5);
}

Eigen::Vector2d at_middle_row(const Camera& camera, const Eigen::Vector2d& pixel, const Vector6d& twist,
                              double depth_m) {
  if (camera.readout_s == 0.0) return pixel;
  const auto xy = undistort(camera, pixel);
  if (!xy) return pixel;
  const Eigen::Isometry3d T_middle_row = perturbation(row_time_s(camera, pixel.y()) * twist);
  const Eigen::Vector3d d_row(xy->x(), xy->y(), 1.0);
  const Eigen::Vector3d p_middle =
      std::isfinite(depth_m) ? T_middle_row * (depth_m * d_row) : Eigen::Vector3d(T_middle_row.linear() * d_row);
  const auto projection = project(camera, p_middle);
  return projection ? projection->pixel : pixel;
}

}  // namespace alidade
