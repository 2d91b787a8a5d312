// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "marker1d/line_row.h"

namespace alidade {

/// A Gaussian spot on a line of pixels.
struct Spot {
  double position_px = 0.0;
  double sigma_px = 0.0;                                  ///< standard deviation of position_px
  Eigen::Array3d amplitude = Eigen::Array3d::Zero();      ///< height above the background per channel, counts
  double amplitude_sigma = 0.0;                           ///< standard deviation of the amplitudes' sum, counts
  Eigen::Array3d channel_sigma = Eigen::Array3d::Zero();  ///< of each channel's amplitude, counts
};

struct SpotFit {
  std::vector<Spot> spots;  ///< in the order of the starts
  double chi2 = 0.0;
  int degrees_of_freedom = 0;
};

/// Pixels first … last of a row.
struct PixelRange {
  int first = 0, last = 0;
};

/// The most likely positions and heights of spots that overlap, all of width `spot_sigma_px` (of the spot as the image
/// shows it, the pixel's own width included), on a common unknown background offset per channel:
///   signal_c(i) = b_c + Σ_j a_jc exp(−(i − x_j)² / 2s²),  variance_c(i) = row.variance + row.shot · signal
/// and 0.3 % of the spot, by which no spot is quite Gaussian.
/// Gauss–Newton on the weighted squares with the variances of the model (quasi-likelihood, which for shot and read
/// noise is the maximum likelihood); the deviations are those of the Cramér–Rao bound. Unusable pixels have no weight.
/// Empty where the pixels do not determine the spots, or one gets negative or leaves the range.
std::optional<SpotFit> fit_spots(const LineRow& row, PixelRange range, std::span<const double> starts,
                                 double spot_sigma_px);

}  // namespace alidade
