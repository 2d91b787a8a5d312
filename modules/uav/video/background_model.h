// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <opencv2/core.hpp>

namespace alidade {

/// Options of BackgroundModel.
struct BackgroundOptions {
  /// Frames over which it forgets: so short that clouds that drift by 0.2 px per frame do not change meanwhile (found
  /// by trial: 20 lose half of the faint dots before clouds, 6 to 10 do alike). What flies slowly is seen none the
  /// less, once it is known to be an object.
  double memory_frames = 8.0;
  double learning_at_objects = 0.1;  ///< how much slower pixels of objects are learnt, so that they leave no trail
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const BackgroundOptions& options);

/// What each pixel shows while nothing flies past: its running mean. The first frames count alike.
class BackgroundModel {
 public:
  explicit BackgroundModel(const BackgroundOptions& options = {});

  /// The image (CV_8UC1) less the mean of the ones learnt before, CV_32FC1, grey levels; all 0 for the first. Throws
  /// std::invalid_argument for an image of another type or size than the first one's.
  cv::Mat residual(const cv::Mat& image);

  /// Learns the frame whose residual this was; within `objects` (px) more slowly.
  void learn(const cv::Mat& residual, std::span<const cv::Rect> objects);

 private:
  BackgroundOptions options_;
  cv::Mat mean_;
  int learnt_ = 0;
};

}  // namespace alidade
