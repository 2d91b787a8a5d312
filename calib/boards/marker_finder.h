// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace alidade {

/// A marker in an image.
struct FoundMarker {
  int id = 0;
  std::array<Eigen::Vector2d, 4> corners;  ///< px, to about a pixel, clockwise from the marker's own top left
};

/// What to look for.
struct MarkerSearch {
  std::string dictionary;
  int border_cells = 1;       ///< width of the markers' black border; Kalibr's AprilGrids have 2
  bool are_touching = false;  ///< other black areas by their corners, as in an AprilGrid
  int enough = 0;             ///< markers that end the search early; 0: looks at everything
};

/// The markers of a dictionary in a grey image of 8 bits, sorted by id; of two with one id the first one found. Throws
/// std::invalid_argument for another type of image or an unknown dictionary. Source: cv::aruco::detectMarkers at two
/// scales and two thresholds.
std::vector<FoundMarker> find_markers(const cv::Mat& grey, const MarkerSearch& search);

}  // namespace alidade
