// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace alidade {

/// What became of a JPEG.
struct DecodedJpeg {
  cv::Mat image;                      ///< 8 bits, grey or BGR; empty where it cannot be decoded at all
  std::optional<std::string> damage;  ///< libjpeg's word for what is broken; what it guessed at is in the image
};

/// Whether the bytes start like a JPEG.
bool is_jpeg(std::string_view bytes);

/// Decodes a JPEG with libjpeg itself, as cv::imdecode does, but keeping its warnings: OpenCV prints them and returns
/// an image that is partly grey or garbled as if it were whole. The pixels of a whole image are OpenCV's, bit by bit.
/// Empty for the few colour spaces (CMYK) that are left to OpenCV.
std::optional<DecodedJpeg> decode_jpeg(std::string_view bytes);

}  // namespace alidade
