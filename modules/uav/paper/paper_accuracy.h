// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

namespace alidade {

/// The covariance (m²) of the ranges (r₁, r₂) of two receivers whose lines of sight meet at `angle_rad`, where the
/// equations err by white noise, `sigma_m` in each coordinate: the paper's model. Throws std::invalid_argument for
/// parallel lines.
/// Source: UAV paper eq. 12.
Eigen::Matrix2d range_covariance(double angle_rad, double sigma_m);

/// The standard deviation (m) of r₁ of n receivers without velocity, under the same noise; `angles_rad` lie between the
/// first line of sight and each of the others. Throws std::invalid_argument where all are parallel.
/// Source: UAV paper eq. 13; for n receivers the sum runs over all (derived).
double range_sigma(std::span<const double> angles_rad, double sigma_m);

/// The covariance of (r₁, r₂) where not the equations but the directions err: across each line of sight, by
/// `sigma1_m` and `sigma2_m` at the target. The errors of the equations are then not white: lateral, growing with
/// range. Throws as range_covariance.
/// Source: derived from UAV paper eq. 8.
Eigen::Matrix2d range_covariance_of_bearings(double angle_rad, double sigma1_m, double sigma2_m);

}  // namespace alidade
