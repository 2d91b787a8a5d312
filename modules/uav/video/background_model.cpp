// SPDX-License-Identifier: Apache-2.0
#include "uav/video/background_model.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {

void validate(const BackgroundOptions& o) {
  if (!(o.memory_frames >= 1.0)) {
    throw std::invalid_argument(fmt::format("memory_frames must be >= 1, got {}", o.memory_frames));
  }
  if (!(o.learning_at_objects >= 0.0 && o.learning_at_objects <= 1.0)) {
    throw std::invalid_argument(fmt::format("learning_at_objects must be in [0, 1], got {}", o.learning_at_objects));
  }
}

BackgroundModel::BackgroundModel(const BackgroundOptions& options) : options_(options) {
  validate(options);
}

cv::Mat BackgroundModel::residual(const cv::Mat& image) {
  if (image.type() != CV_8UC1) throw std::invalid_argument("BackgroundModel: images must be grey, of 8 bits");
  if (mean_.empty()) image.convertTo(mean_, CV_32FC1);
  if (image.size() != mean_.size()) throw std::invalid_argument("BackgroundModel: images must be of one size");
  cv::Mat residual;
  cv::subtract(image, mean_, residual, cv::noArray(), CV_32FC1);
  return residual;
}

void BackgroundModel::learn(const cv::Mat& residual, std::span<const cv::Rect> objects) {
  ++learnt_;
  const double share = std::max(1.0 / learnt_, 1.0 / options_.memory_frames);
  cv::Mat softened = objects.empty() ? residual : residual.clone();
  for (const cv::Rect& object : objects) softened(object & cv::Rect({}, mean_.size())) *= options_.learning_at_objects;
  cv::scaleAdd(softened, share, mean_, mean_);
}

}  // namespace alidade
