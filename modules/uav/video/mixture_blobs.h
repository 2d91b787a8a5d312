// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <opencv2/video/background_segm.hpp>

namespace alidade {

/// Options of MixtureBlobDetector.
struct MixtureBlobOptions {
  int history = 100;  ///< frames that the background is learnt over
  double variance_threshold =
      16.0;               ///< squared standard deviations beyond which a pixel is foreground; OpenCV's default
  int least_area_px = 2;  ///< of a blob; single pixels are noise
  int greatest_area_px = 150;
};

/// The usual way, to compare with: OpenCV's mixture of Gaussians for each pixel (MOG2, Zivkovic 2004), and the centres
/// of connected foreground pixels.
class MixtureBlobDetector {
 public:
  /// Throws std::invalid_argument unless history >= 1, variance_threshold > 0 and the areas are in order.
  explicit MixtureBlobDetector(const MixtureBlobOptions& options = {});

  /// The centres (px) of the blobs in the next frame, an image of 8 bits.
  std::vector<Eigen::Vector2d> detect(const cv::Mat& image);

 private:
  MixtureBlobOptions options_;
  cv::Ptr<cv::BackgroundSubtractorMOG2> background_;
};

}  // namespace alidade
