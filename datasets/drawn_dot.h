// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace alidade {

/// How a far object looks: an evenly grey disc.
struct DrawnDot {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< its centre
  double size_px = 3.0;                             ///< its diameter
  double contrast = 10.0;                           ///< grey levels that it adds to what is behind it; dark: negative
};

/// Adds a dot to a picture (CV_32FC1): the disc's share of each pixel's area times its contrast, blurred by a lens of
/// standard deviation blur_px; exact to 1 % of the contrast. What lies outside the picture is left out. Throws
/// std::invalid_argument for a picture of another type, and a size that is not positive.
void draw_dot(cv::Mat& picture, const DrawnDot& dot, double blur_px = 0.0);

}  // namespace alidade
