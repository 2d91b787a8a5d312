// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "calib/bundle/bundle_covariance.h"

namespace alidade {

/// ∂pixel of what camera `index` sees at `pixel`, `distance_m` away, by the shared parameters and the boards' mean
/// motion (the order of BundleCovariance), 2 x n. Empty where the lens has no direction for the pixel.
std::optional<Eigen::MatrixXd> pixel_jacobian(const BoardBundle& bundle, const BundleFreedom& freedom, int index,
                                              const Eigen::Vector2d& pixel, double distance_m);

/// The same at 5 x 5 places over every camera's image, at the boards' median distance; without those that are empty.
std::vector<Eigen::MatrixXd> pixel_jacobians(const BundleFit& fit, const BundleFreedom& freedom);

/// Covariance (px²) of the pixel at which a point is imaged that truly lies `distance_m` away in the direction of
/// `pixel`: how far the calibration's errors move it. Empty as pixel_jacobian.
std::optional<Eigen::Matrix2d> pixel_covariance(const BundleCovariance& covariance, const BoardBundle& bundle,
                                                const BundleFreedom& freedom, int index, const Eigen::Vector2d& pixel,
                                                double distance_m);

/// The median distance from a camera, m, of the centres of the boards in its views (those with weight); 1 without any.
double median_distance_m(const BundleFit& fit, const BoardShape& shape, int index);

/// Standard deviations of a pixel's place over the image (the larger axis of its covariance), row by row.
struct UncertaintyMap {
  int columns = 0, rows = 0;
  double step_px = 0;            ///< from one place to the next, beginning at pixel (0, 0)
  std::vector<double> sigma_px;  ///< NaN where the lens has no direction
};

/// About `columns` places along a row.
UncertaintyMap uncertainty_map(const BundleCovariance& covariance, const BoardBundle& bundle,
                               const BundleFreedom& freedom, int index, double distance_m, int columns = 32);

}  // namespace alidade
