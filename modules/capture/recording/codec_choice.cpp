// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/codec_choice.h"

#include <algorithm>

#include <opencv2/core.hpp>

#include "io/lossless_encoder.h"

namespace alidade {
namespace {

using Clock = std::chrono::steady_clock;

// Noise in the lower quarter of the bits: more than any camera's.
cv::Mat noise_like(const cv::Mat& image) {
  cv::Mat noise(image.size(), image.type());
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, image.depth() == CV_16U ? 1024 : 64);
  return noise;
}

Clock::duration packing_time(const cv::Mat& image, const LosslessFormat& format) {
  LosslessEncoder encoder(format);
  const cv::Mat noise = noise_like(image);
  encoder.encode(image);  // the first one sets up
  const auto start = Clock::now();
  encoder.encode(image);
  const auto middle = Clock::now();
  encoder.encode(noise);
  return std::max(middle - start, Clock::now() - middle);
}

}  // namespace

LosslessCodec choose_codec(const cv::Mat& image, PixelLayout layout, cv::Size size, std::chrono::nanoseconds period,
                           const RecorderOptions& options) {
  if (layout == PixelLayout::Jpeg) return LosslessCodec::Raw;
  if (options.codec) return *options.codec;
  const std::chrono::duration<double> allowed = options.busy_share * std::chrono::duration<double>(period);
  for (const auto codec : {LosslessCodec::Ffv1, LosslessCodec::FfvHuff}) {
    if (packing_time(image, {layout, size, codec}) < allowed) return codec;
  }
  return LosslessCodec::Raw;
}

}  // namespace alidade
