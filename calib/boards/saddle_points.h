// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace alidade {

/// A place where two edges cross and the grey alternates about it, as at the inner corners of a chessboard.
struct SaddlePoint {
  Eigen::Vector2d pixel;  ///< px, to a few tenths
  /// Directions of the edges in [0, pi), from x towards y. Turning from the first one to the second (by less than pi)
  /// one crosses bright pixels: at neighbouring corners of a chessboard the two are swapped.
  std::array<double, 2> edges_rad;
  double strength = 0;  ///< root of -det of the smoothed image's Hessian, grey levels / px²
};

/// The saddle points of a grey image of 8 bits, strongest first, of no more than 3000 candidates. Edges must be sharp
/// to about 3 px and squares wider than 4: search a larger or a smaller image for others. Throws std::invalid_argument
/// for another type of image. Source: maxima of -det of the Hessian, kept where rings of pixels about them turn from
/// bright to dark and back twice, as in Bennett and Lasenby, "ChESS" (2014).
std::vector<SaddlePoint> find_saddle_points(const cv::Mat& grey);

/// Between directions in [0, pi) that stand for the lines along them: at most pi / 2.
double angle_between_lines(double one_rad, double other_rad);

}  // namespace alidade
