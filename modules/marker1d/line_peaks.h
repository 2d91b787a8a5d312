// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "marker1d/line_row.h"

namespace alidade {

/// A spot of light in a row of pixels; pixel 0 is the centre of the first one.
struct LinePeak {
  double position_px = 0.0;
  double sigma_px = 0.0;                                  ///< standard deviation of position_px; finite, > 0
  Eigen::Array3d amplitude = Eigen::Array3d::Zero();      ///< height above the background per channel, counts
  Eigen::Array3d channel_sigma = Eigen::Array3d::Zero();  ///< its standard deviation
  double snr = 0.0;            ///< height (sum of the channels) over its standard deviation's share of pixel noise
  bool is_saturated = false;   ///< the position rests on the flanks
  bool is_overlapped = false;  ///< fitted together with a neighbour, or wider than a spot: sigma_px says how well
};

struct LinePeakOptions {
  /// Standard deviation of a spot's profile as the image shows it, the pixel's own width included.
  double spot_sigma_px = 1.2;
  /// Least matched-filter response, in standard deviations of the row's noise: 5 passes noise alone once in 2000 rows
  /// of 2048 px, and a spot as high as 5 times the noise 49 times of 50.
  double threshold = 5.0;
  PixelNoise noise;         ///< read 0: from the row itself
  double saturation = 0.0;  ///< counts; 0: the largest value of the image's type
};

/// Throws std::invalid_argument naming the field, its value and the bound.
void validate(const LinePeakOptions& options);

/// The spots of one row, from left to right: matched filter, then maximum likelihood of position and height
/// (fit_spots). Spots nearer than 7 spot_sigma_px are fitted together, and one that is not explained by a single spot
/// is tried as two. Empty where nothing stands out. Throws std::invalid_argument for impossible options and rows
/// (prepare_row).
std::vector<LinePeak> find_peaks(const cv::Mat& row, const LinePeakOptions& options = {});

/// The same for one channel of any unit; values that are not finite count as unseen.
std::vector<LinePeak> find_peaks(std::span<const float> row, const LinePeakOptions& options = {});

/// The width of the spots in rows of a line image (all rows are looked at, up to 64 evenly spread): that by which
/// single, unsaturated spots are explained best. Empty where there are fewer than three. Throws as find_peaks.
std::optional<double> estimate_spot_sigma(const cv::Mat& rows, const LinePeakOptions& options = {});

}  // namespace alidade
