// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace alidade {

/// What is known of a crossing before the fit. The window is the parallelogram of all pixels p with
/// p - pixel = u * step_x + v * step_y, |u| and |v| <= half_width, one of them <= band.
struct CrossingStart {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();   ///< px, well inside the window
  Eigen::Vector2d step_x = {1, 0}, step_y = {0, 1};  ///< to the next crossings, along the two edges, px
  /// How the edges bend there: t steps along step_x an edge lies at t step_x + t²/2 bend_x, px.
  Eigen::Vector2d bend_x = Eigen::Vector2d::Zero(), bend_y = Eigen::Vector2d::Zero();
  double half_width = 0.4;  ///< of the window, in steps
  double band = 1;          ///< to either side of an edge, in steps; where squares carry marks, what is free of them
  int stride = 1;           ///< every so many pixels of the window's rows and columns are looked at
  double blur_px = 1;       ///< to start from
};

/// Two edges between dark and light that cross, straight or bent as CrossingStart says, each blurred by its own
/// Gaussian (focus and motion): I(p) = b + g·(p - c0) + (a + h·(p - c0)) erf(d1 / (√2 s1)) erf(d2 / (√2 s2)), d the
/// signed distance from an edge, c0 the start.
struct EdgeCrossing {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();           ///< where the edges cross, px
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();  ///< of pixel: residual noise times inverse information
  std::array<double, 2> angle_rad = {0, 0};                  ///< of the edges along step_x and step_y, from x towards y
  std::array<double, 2> blur_px = {0, 0};                    ///< s1 and s2, standard deviations
  double contrast = 0;                                       ///< |a|, half of light less dark, grey levels
  double noise = 0;                                          ///< standard deviation of the residuals, grey levels
};

/// The crossing in a grey image of 8 bits, by Levenberg-Marquardt over the pixels of the window that lie in the image.
/// The product of two blurred edges is exact at right angles; at all others it keeps the point symmetry of the truth,
/// so that the crossing stays in place. Empty where fewer than 30 pixels are looked at or the fit ends nowhere: outside
/// the window, more blurred than the window is wide, or with edges that nearly coincide. Throws std::invalid_argument
/// for another type of image.
std::optional<EdgeCrossing> fit_edge_crossing(const cv::Mat& grey, const CrossingStart& start);

/// Where the gradients about `pixel` say that edges cross, within `half_width_px` (cv::cornerSubPix): what is left
/// where the fit fails. `pixel` itself where no window about it fits the image.
Eigen::Vector2d crossing_by_gradients(const cv::Mat& grey, const Eigen::Vector2d& pixel, int half_width_px);

}  // namespace alidade
