// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/codec_choice.h"

#include <algorithm>

#include <opencv2/core.hpp>

#include "io/lossless_encoder.h"

namespace alidade {
namespace {

using Seconds = std::chrono::duration<double>;

// The upper rows of an image, as many as make about 200,000 pixels, and an even number.
cv::Size sample_of(cv::Size size) {
  constexpr int kPixels = 200'000;
  return {size.width, std::min(size.height, std::max(kPixels / size.width, 16) / 2 * 2)};
}

// Five bits of noise in eight; as much of twelve, since their upper bits change less often.
cv::Mat noise(PixelLayout layout, cv::Size size) {
  cv::Mat image(mat_size(layout, size), mat_type(layout));
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, image.depth() == CV_16U ? 512 : 32);
  return image;
}

// For an image of `size`.
Seconds packing_time(const LosslessFormat& format, cv::Size size) {
  LosslessEncoder encoder(format);
  const cv::Mat image = noise(format.layout, format.size);
  encoder.encode(image);  // the first one sets up
  const auto start = std::chrono::steady_clock::now();
  encoder.encode(image);
  return (std::chrono::steady_clock::now() - start) * (static_cast<double>(size.height) / format.size.height);
}

}  // namespace

LosslessCodec choose_codec(PixelLayout layout, cv::Size size, std::chrono::nanoseconds period,
                           const RecorderOptions& options) {
  if (layout == PixelLayout::Jpeg) return LosslessCodec::Raw;
  if (options.codec) return *options.codec;
  const Seconds allowed = options.busy_share * Seconds(period);
  for (const auto codec : {LosslessCodec::Ffv1, LosslessCodec::FfvHuff}) {
    if (packing_time({layout, sample_of(size), codec}, size) < allowed) return codec;
  }
  return LosslessCodec::Raw;
}

}  // namespace alidade
