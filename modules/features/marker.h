// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace alidade {

/// A square fiducial marker in an image.
struct MarkerSighting {
  int id = -1;
  std::array<Eigen::Vector2d, 4> corners;  ///< px, clockwise from the marker's own top left
};

/// The families of markers that are looked for, each with its own ids.
enum class MarkerFamily { AprilTag36h11, Aruco4x4, Aruco5x5, Aruco6x6 };

/// Markers of one family in an 8-bit grey image, corners to a fraction of a pixel (OpenCV's detector).
std::vector<MarkerSighting> detect_markers(const cv::Mat& grey, MarkerFamily family);

/// The first family with a marker in the image, in the order above, and its markers; empty where there is none.
std::vector<MarkerSighting> detect_markers(const cv::Mat& grey);

}  // namespace alidade
