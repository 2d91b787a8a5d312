// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "uav/video/dot_filter.h"

namespace alidade {

/// A small round dot in an image.
struct FittedDot {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();       ///< its centre
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of pixel, px²: what the noise about it makes
  double height_grey = 0.0;                              ///< of its middle above what is behind it; dark: negative
  double sigma_px = 0.0;                                 ///< of its Gaussian
  double noise_grey = 0.0;                               ///< standard deviation of a pixel about it
};

/// Options of fit_dot.
struct DotFitOptions {
  double least_sigma_px = 0.35;    ///< narrower is a single bad pixel: a point's image through the pixel alone has 0.29
  double greatest_sigma_px = 2.6;  ///< wider is a cloud, a bird near by or a tree: a disc of 10 px has 2.5
  double most_move_px = 2.0;       ///< of the centre from the peak
  double least_height = 2.0;       ///< of the dot, in standard deviations of a pixel's noise
  double most_misfit = 0.25;       ///< root mean square beside noise, in heights: an edge has 0.3 and more, a disc 0.05
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const DotFitOptions& options);

/// Least squares of a round Gaussian on a plane (brightness and its slope) to the pixels of a residual (CV_32FC1) about
/// a peak; the noise is that of the pixels farther out. Covariance: the Cramér–Rao bound for white noise,
/// (Jᵀ J)⁻¹ noise², with the mean squared misfit in place of noise² where that is larger. Empty where it does not
/// settle within the options' bounds, or the noise is zero.
std::optional<FittedDot> fit_dot(const cv::Mat& residual, const DotPeak& peak, const DotFitOptions& options = {});

/// The diameter of the disc to which a Gaussian of this standard deviation is fitted, once the pixel's own width and a
/// lens' blur (px) are taken off: to 6 % from 3 px on, while one of 2 px looks up to a fifth smaller; 0 where nothing
/// is left.
double disc_diameter_px(double sigma_px, double blur_px);

}  // namespace alidade
