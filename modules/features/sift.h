// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "geometry/point_map.h"

namespace alidade {

/// Distinctive points of one image.
struct Features {
  std::vector<Eigen::Vector2d> pixels;  ///< px
  std::vector<float> sizes;             ///< diameter of the region described, px
  cv::Mat descriptors;                  ///< N×128 float32: RootSIFT scaled to 0–255

  int size() const { return static_cast<int>(pixels.size()); }
};

struct SiftOptions {
  int most = 2000;   ///< the strongest ones are kept; about one per 150 px² of a 640×480 image
  int fewest = 400;  ///< below it the contrast threshold is lowered, down to lowest_contrast
  double contrast =
      0.01;  ///< of the difference of Gaussians, grey levels of 0–1 (OpenCV's default 0.04 starves dark images)
  double lowest_contrast = 0.002;
};

/// SIFT features of an 8-bit grey image, the strongest first where there are more than `most`; the contrast threshold
/// is lowered until there are `fewest`. OpenCV's constant offset of a quarter pixel is taken out.
/// Throws std::invalid_argument for another kind of image. Source: Lowe 2004; Arandjelović and Zisserman 2012 (root).
Features detect_sift(const cv::Mat& grey, const SiftOptions& options = {});

/// Row `index` as bytes, and back to a row of float32.
Descriptor descriptor_bytes(const Features& features, int index);
cv::Mat descriptor_rows(const std::vector<const Descriptor*>& descriptors);

}  // namespace alidade
