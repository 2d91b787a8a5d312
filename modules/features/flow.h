// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace alidade {

struct FlowOptions {
  int window_px = 21;              ///< side of the patch that is followed; OpenCV's default
  int levels = 3;                  ///< pyramid levels above the image: reach about 80 px
  double most_return_px = 0.7;     ///< forward and back again must end this near to the start
  double least_eigenvalue = 1e-3;  ///< of the patch's gradient matrix, grey levels of 0–1: flatter patches slide
};

/// An image with its pyramid, built once and used against both neighbours.
struct FlowImage {
  cv::Mat grey;
  std::vector<cv::Mat> pyramid;
};

FlowImage make_flow_image(const cv::Mat& grey, const FlowOptions& options = {});

/// Follows points from one image into another by Lucas–Kanade optical flow, starting from `guesses` (as many as
/// points): the pixel in `to`, or empty where the patch is lost, leaves the image or does not come back.
/// Source: Bouguet 2001 (OpenCV).
std::vector<std::optional<Eigen::Vector2d>> follow_points(const FlowImage& from, const FlowImage& to,
                                                          const std::vector<Eigen::Vector2d>& points,
                                                          const std::vector<Eigen::Vector2d>& guesses,
                                                          const FlowOptions& options = {});

}  // namespace alidade
