// SPDX-License-Identifier: Apache-2.0
#include "io/lossless_format.h"

#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/core/hal/interface.h>

namespace alidade {

std::string_view name_of(LosslessCodec codec) {
  if (codec == LosslessCodec::Raw) return "raw";
  return codec == LosslessCodec::FfvHuff ? "ffvhuff" : "ffv1";
}

std::optional<LosslessCodec> parse_lossless_codec(std::string_view name) {
  for (const auto codec : {LosslessCodec::Raw, LosslessCodec::FfvHuff, LosslessCodec::Ffv1}) {
    if (name_of(codec) == name) return codec;
  }
  return std::nullopt;
}

void validate(const LosslessFormat& format) {
  const auto [width, height] = format.size;
  const bool halves_width = format.layout == PixelLayout::Yuyv || format.layout == PixelLayout::Nv12;
  if (width <= 0 || height <= 0) throw std::invalid_argument("LosslessFormat: size must be > 0 px");
  if ((halves_width && width % 2 != 0) || (format.layout == PixelLayout::Nv12 && height % 2 != 0)) {
    throw std::invalid_argument(fmt::format("LosslessFormat: size must be even, got {}x{} px", width, height));
  }
  if (format.layout == PixelLayout::Jpeg && format.codec != LosslessCodec::Raw) {
    throw std::invalid_argument("LosslessFormat: codec of JPEG images must be raw");
  }
}

int mat_type(PixelLayout layout) {
  switch (layout) {
    case PixelLayout::Grey8:
    case PixelLayout::Nv12:
      return CV_8UC1;
    case PixelLayout::Grey16:
      return CV_16UC1;
    case PixelLayout::Bgr24:
      return CV_8UC3;
    case PixelLayout::Yuyv:
      return CV_8UC2;
    case PixelLayout::Jpeg:
      break;
  }
  throw std::invalid_argument("mat_type: a JPEG's length varies");
}

cv::Size mat_size(PixelLayout layout, cv::Size size) {
  if (layout == PixelLayout::Jpeg) throw std::invalid_argument("mat_size: a JPEG's length varies");
  return layout == PixelLayout::Nv12 ? cv::Size(size.width, size.height * 3 / 2) : size;
}

}  // namespace alidade
