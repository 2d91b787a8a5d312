// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "io/video_writer.h"

namespace alidade::test {

/// Frame `index` of a clip: noise of its own, in blocks of 8 px so that a movie keeps it well.
inline cv::Mat clip_frame(int index, cv::Size size, int type) {
  cv::Mat blocks(size.height / 8 + 1, size.width / 8 + 1, type);
  cv::RNG rng(static_cast<std::uint64_t>(index) + 1);
  rng.fill(blocks, cv::RNG::UNIFORM, 30, 220);
  cv::Mat image(size, type);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (type == CV_8UC1)
        image.at<unsigned char>(y, x) = blocks.at<unsigned char>(y / 8, x / 8);
      else
        image.at<cv::Vec3b>(y, x) = blocks.at<cv::Vec3b>(y / 8, x / 8);
    }
  }
  return image;
}

/// Writes `count` frames of the clip.
inline void write_clip(const std::filesystem::path& path, int count, const VideoOptions& options,
                       cv::Size size = {160, 120}, int type = CV_8UC3) {
  VideoWriter writer(path, size, options);
  for (int i = 0; i < count; ++i) writer.write(clip_frame(i, size, type));
  writer.close();
}

}  // namespace alidade::test
