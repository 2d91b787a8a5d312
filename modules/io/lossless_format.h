// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <opencv2/core/types.hpp>

namespace alidade {

/// How the pixels of a lossless video lie in a cv::Mat of w × h px.
enum class PixelLayout {
  Grey8,   ///< CV_8UC1
  Grey16,  ///< CV_16UC1
  Bgr24,   ///< CV_8UC3
  Yuyv,    ///< CV_8UC2, w even: luma, and in turn blue and red difference
  Nv12,    ///< CV_8UC1 of 3h/2 rows, w and h even: luma, then blue and red difference in turn at half the resolution
  Jpeg,    ///< CV_8UC1, one row: the bytes of a JPEG image
};

/// How they are packed. The smaller the file, the more there is to compute.
enum class LosslessCodec {
  Raw,      ///< as they are; a JPEG stays one
  FfvHuff,  ///< Huffman codes of differences
  Ffv1,     ///< FFV1 version 3, with a checksum for each slice
};

/// "raw", "ffvhuff", "ffv1"
std::string_view name_of(LosslessCodec codec);

/// The codec of that name; empty where there is none.
std::optional<LosslessCodec> parse_lossless_codec(std::string_view name);

struct LosslessFormat {
  PixelLayout layout = PixelLayout::Grey8;
  cv::Size size;  ///< px
  LosslessCodec codec = LosslessCodec::Ffv1;
};

/// Throws std::invalid_argument where the size is not positive, odd where it must be even, or a JPEG is to be packed.
void validate(const LosslessFormat& format);

/// The type and size of the cv::Mat of a frame. Not for JPEG (std::invalid_argument).
int mat_type(PixelLayout layout);
cv::Size mat_size(PixelLayout layout, cv::Size size);

}  // namespace alidade
