// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace alidade {

struct PatchAlignmentOptions {
  int side_px = 15;                ///< of the reference patch
  double least_correlation = 0.9;  ///< of the two patches once aligned; a patch on an edge in depth does not get there
  double most_shift_px = 2.0;      ///< from the pixel that the search starts from
  int most_iterations = 30;
};

struct AlignedPatch {
  Eigen::Vector2d pixel;   ///< of the reference pixel's likeness, px
  double correlation = 0;  ///< enhanced correlation coefficient, at most 1
};

/// Where in `image` the texture about `reference_pixel` of `reference` (both 8-bit grey) is seen, starting from `pixel`
/// and the affine map A (∂ image pixel / ∂ reference pixel), which are both refined; brightness and contrast are free.
/// Empty where a patch leaves its image or the two do not agree. Source: Evangelidis and Psarakis 2008 (OpenCV).
std::optional<AlignedPatch> align_patch(const cv::Mat& reference, const Eigen::Vector2d& reference_pixel,
                                        const cv::Mat& image, const Eigen::Vector2d& pixel,
                                        const Eigen::Matrix2d& A_image_reference,
                                        const PatchAlignmentOptions& options = {});

}  // namespace alidade
