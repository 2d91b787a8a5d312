// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "features/flow.h"

namespace alidade {

/// Options of ImageStabiliser.
struct StabiliserOptions {
  int corners = 120;                 ///< that are followed; the turn is then known to 0.01 px at the image's border
  double corner_distance_px = 20.0;  ///< least between two of them, so that they spread
  /// Least root of the smaller eigenvalue of a corner's gradient matrix, grey levels per px: ten times what a noise of
  /// 3 grey levels makes. Clouds are softer than that; hills, trees and houses are not.
  double least_gradient_grey = 6.0;
  int least_corners = 12;       ///< that agree; with fewer the image is taken as it is
  double inlier_px = 0.5;       ///< a corner further from the common motion than this does not stand still
  double most_shift_px = 12.0;  ///< more than this is no swaying: what was followed does not stand still
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const StabiliserOptions& options);

/// How the image of a standing camera sways, from what stands still in it: corners of the first image are followed into
/// every other one, and a shift with a small turn is fitted to most of them.
class ImageStabiliser {
 public:
  explicit ImageStabiliser(const StabiliserOptions& options = {});

  /// The motion T_image_first by which pixels of the first image come to where `grey` (8 bits) shows the same: the
  /// identity for the first. Empty where too little stands still, such as in a picture of nothing but sky.
  std::optional<Eigen::Isometry2d> follow(const cv::Mat& grey);

  /// Where a pixel of the first image is on average over all images so far: about where it is while nothing sways.
  Eigen::Vector2d mean_pixel(const Eigen::Vector2d& first) const;

  /// How well that is known, px²: the variance of the swaying over the number of times that it has come back. What it
  /// errs by stays much the same from frame to frame.
  Eigen::Matrix2d mean_covariance() const;

 private:
  void remember(const Eigen::Vector3d& sway);

  StabiliserOptions options_;
  FlowOptions flow_options_;
  std::optional<FlowImage> first_;
  std::vector<Eigen::Vector2d> corners_;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero(), sum_ = Eigen::Vector3d::Zero();  // shift px, turn rad
  Eigen::Vector2d sum_of_squares_ = Eigen::Vector2d::Zero();                        // of the shift
  Eigen::Vector2d returns_ = Eigen::Vector2d::Zero();                               // how often it crossed its mean
  int followed_ = 0;
};

}  // namespace alidade
