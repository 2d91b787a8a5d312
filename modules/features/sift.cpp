// SPDX-License-Identifier: Apache-2.0
#include "features/sift.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <opencv2/features2d.hpp>

namespace alidade {
namespace {

// OpenCV up to 4.6 doubles the image with aligned corners' centres but halves the coordinates with aligned centres:
// every key point lies a quarter pixel too far right and down (measured in tests/features/sift_test.cpp).
constexpr double kDoublingOffset = 0.25;

void take_square_roots(cv::Mat& descriptors) {
  for (int r = 0; r < descriptors.rows; ++r) {
    cv::Mat row = descriptors.row(r);
    const double sum = cv::norm(row, cv::NORM_L1);
    if (sum > 0) row /= sum;
    cv::sqrt(row, row);
  }
  cv::Mat scaled;
  descriptors.convertTo(scaled, CV_8U, 512.0);  // as bytes, so that a saved map matches exactly as the live one
  scaled.convertTo(descriptors, CV_32F);
}

}  // namespace

Features detect_sift(const cv::Mat& grey, const SiftOptions& options) {
  if (grey.empty() || grey.type() != CV_8UC1) throw std::invalid_argument("detect_sift: needs an 8-bit grey image");
  std::vector<cv::KeyPoint> keypoints;
  Features features;
  for (double contrast = options.contrast;; contrast *= 0.4) {
    const auto sift = cv::SIFT::create(options.most, 3, contrast, 10, 1.6);
    keypoints.clear();
    sift->detectAndCompute(grey, cv::noArray(), keypoints, features.descriptors);
    if (static_cast<int>(keypoints.size()) >= options.fewest || contrast * 0.4 < options.lowest_contrast) break;
  }
  for (const cv::KeyPoint& keypoint : keypoints) {
    features.pixels.emplace_back(keypoint.pt.x - kDoublingOffset, keypoint.pt.y - kDoublingOffset);
    features.sizes.push_back(keypoint.size);
  }
  take_square_roots(features.descriptors);
  return features;
}

Descriptor descriptor_bytes(const Features& features, int index) {
  Descriptor bytes{};
  const float* row = features.descriptors.ptr<float>(index);
  std::transform(row, row + bytes.size(), bytes.begin(), [](float v) { return static_cast<std::uint8_t>(v); });
  return bytes;
}

cv::Mat descriptor_rows(const std::vector<const Descriptor*>& descriptors) {
  cv::Mat rows(static_cast<int>(descriptors.size()), 128, CV_32F);
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    std::copy(descriptors[i]->begin(), descriptors[i]->end(), rows.ptr<float>(static_cast<int>(i)));
  }
  return rows;
}

}  // namespace alidade
