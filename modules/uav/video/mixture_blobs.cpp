// SPDX-License-Identifier: Apache-2.0
#include "uav/video/mixture_blobs.h"

#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace alidade {

MixtureBlobDetector::MixtureBlobDetector(const MixtureBlobOptions& options) : options_(options) {
  if (options.history < 1) throw std::invalid_argument(fmt::format("history must be >= 1, got {}", options.history));
  if (!(options.variance_threshold > 0.0)) {
    throw std::invalid_argument(fmt::format("variance_threshold must be > 0, got {}", options.variance_threshold));
  }
  if (options.least_area_px < 1 || options.greatest_area_px < options.least_area_px) {
    throw std::invalid_argument("least_area_px must be >= 1 and <= greatest_area_px");
  }
  constexpr bool kShadows = false;
  background_ = cv::createBackgroundSubtractorMOG2(options.history, options.variance_threshold, kShadows);
}

std::vector<Eigen::Vector2d> MixtureBlobDetector::detect(const cv::Mat& image) {
  cv::Mat foreground, labels, statistics, centres;
  background_->apply(image, foreground);
  const int blobs = cv::connectedComponentsWithStats(foreground, labels, statistics, centres, 8);
  std::vector<Eigen::Vector2d> found;
  for (int i = 1; i < blobs; ++i) {  // 0 is the background
    const int area = statistics.at<int>(i, cv::CC_STAT_AREA);
    if (area < options_.least_area_px || area > options_.greatest_area_px) continue;
    found.emplace_back(centres.at<double>(i, 0), centres.at<double>(i, 1));
  }
  return found;
}

}  // namespace alidade
