// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace alidade {

/// What scatters the pixels of a line image: variance = read² + shot · (light in the pixel), counts².
struct PixelNoise {
  double read = 0.0;  ///< standard deviation without light, counts; 0: taken from the row itself
  double shot = 0.0;  ///< counts per electron, i.e. 1 / (electrons per count); 0: no shot noise
};

/// One exposure of a line image, made ready for finding spots: what stands out of the background. Arrays are pixels ×
/// channels, in counts.
struct LineRow {
  Eigen::ArrayXXd signal;    ///< above the background, which is piecewise linear between medians of 64 pixels
  Eigen::ArrayXXd variance;  ///< of a pixel without a spot, counts²; > 0
  Eigen::Array<bool, Eigen::Dynamic, 1> is_saturated;  ///< in any channel
  Eigen::Array<bool, Eigen::Dynamic, 1> is_usable;     ///< finite and not saturated in all channels
  double shot = 0.0;                                   ///< PixelNoise::shot
};

/// From a row of 8 or 16 bits, 1 × N, one or three channels; saturated is the type's largest value, or `saturation`
/// (counts) where that is > 0. Throws std::invalid_argument for any other shape or type.
LineRow prepare_row(const cv::Mat& row, const PixelNoise& noise = {}, double saturation = 0.0);

/// From one channel of any unit; values that are not finite count as unseen. Saturated from `saturation` on, where it
/// is > 0.
LineRow prepare_row(std::span<const float> row, const PixelNoise& noise = {}, double saturation = 0.0);

}  // namespace alidade
