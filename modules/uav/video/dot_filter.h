// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

namespace alidade {

/// Options of DotFilter.
struct DotFilterOptions {
  /// Standard deviations of the filters' Gaussians, px. A disc of diameter d has d/4 along each axis, the pixel 0.29,
  /// a sharp lens 0.5: these two fit 2 to 3.5 and 3.5 to 7 px, and lose less than a tenth of the signal in between.
  std::array<double, 2> sigmas_px{0.85, 1.4};
  int surround_px =
      15;  ///< side of the square whose mean is taken off: wider than any dot, narrower than clouds' waves
  /// Least response, in standard deviations of what the filter gives at this place and time. Low: noise passes it a
  /// thousand times in a frame of a million pixels; what does is then asked to move on like an object (ShortTracks).
  double threshold = 3.0;
  double memory_frames = 50.0;    ///< over which each pixel's noise is learnt: to a tenth
  double least_noise_grey = 0.5;  ///< of a pixel; where the sensor is saturated there is none, and rounding makes 0.3
  int border_px = 8;              ///< not looked at along the image's border
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const DotFilterOptions& options);

/// A place where something small stands out.
struct DotPeak {
  cv::Point pixel;
  cv::Point2d summit;     ///< of the parabolas through the response there and beside, px: good to a few tenths
  double sigma_px = 0.0;  ///< of the filter that answered best
  double response = 0.0;  ///< in standard deviations of the noise; bright: positive
};

/// Finds small dots in what is left of frames once their background is taken off. Matched filters: Gaussians, less the
/// mean of the surround. The noise of their response is learnt for each pixel over time (edges that sway, leaves that
/// move, drifting clouds) and, where that is larger, taken from the surround in the same frame (a cloud's edge that has
/// just come): a constant rate of false alarms.
class DotFilter {
 public:
  explicit DotFilter(const DotFilterOptions& options = {});

  /// The peaks of a residual (CV_32FC1) above the threshold, in order of rows, the strongest alone within
  /// 2 sigma_px + 2 px. Then learns the frame's noise. All residuals are of one size, else std::invalid_argument.
  std::vector<DotPeak> find(const cv::Mat& residual);

 private:
  struct Scale {
    double sigma_px;
    cv::Mat response, variance;
    double least_variance;
  };
  void learn(Scale& scale) const;
  double local_variance(const Scale& scale, const cv::Point& pixel) const;
  void collect(const Scale& scale, std::vector<DotPeak>& peaks) const;

  DotFilterOptions options_;
  std::vector<Scale> scales_;
  int seen_ = 0;
};

}  // namespace alidade
