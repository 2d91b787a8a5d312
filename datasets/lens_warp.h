// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "camera/camera.h"

namespace alidade {

/// Makes pictures of a camera with distortion from pictures of a wider pinhole camera at the same place.
class LensWarp {
 public:
  /// The maps work on pictures `supersampling` times as large. Throws std::invalid_argument where the distortion has
  /// no inverse somewhere in the image, or takes more than three times its extent.
  LensWarp(const Camera& camera, int supersampling);

  /// The pinhole camera to draw: it sees all that the distorted one sees, with the same focal length, at the size of
  /// the finished picture (not supersampled).
  const Camera& pinhole() const { return pinhole_; }

  /// The distorted picture at the camera's size from one of resized(pinhole(), supersampling).
  cv::Mat distort(const cv::Mat& large) const;

  /// The distorted image of depths (CV_32FC1, along the axis) from one of pinhole(): the nearest pixel's.
  cv::Mat distort_depth(const cv::Mat& depth) const;

 private:
  Camera camera_;
  Camera pinhole_;
  cv::Mat map_;        // CV_32FC2: for each large pixel of the camera, where it is in the large pinhole picture
  cv::Mat depth_map_;  // the same without supersampling
};

}  // namespace alidade
