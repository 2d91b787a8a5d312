// SPDX-License-Identifier: Apache-2.0
#include "capture/pixel_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

constexpr std::array<const char*, 4> kPatternNames{"RG", "GR", "GB", "BG"};

std::string upper(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::toupper(c); });
  return result;
}

}  // namespace

std::string name_of(const PixelFormat& format) {
  switch (format.kind) {
    case PixelKind::Grey:
      return fmt::format("Mono{}", format.bits);
    case PixelKind::Bayer:
      return fmt::format("Bayer{}{}", kPatternNames[static_cast<std::size_t>(format.pattern)], format.bits);
    case PixelKind::Bgr:
      return "BGR8";
    case PixelKind::Yuyv:
      return "YUYV";
    case PixelKind::Nv12:
      return "NV12";
    case PixelKind::Jpeg:
      return "JPEG";
  }
  return "";
}

std::optional<PixelFormat> parse_pixel_format(std::string_view name) {
  const std::string wanted = upper(name);
  for (const PixelKind kind : {PixelKind::Bgr, PixelKind::Yuyv, PixelKind::Nv12, PixelKind::Jpeg}) {
    if (upper(name_of(PixelFormat{kind})) == wanted) return PixelFormat{kind};
  }
  for (const int bits : {8, 10, 12, 14, 16}) {
    if (upper(name_of(PixelFormat{PixelKind::Grey, bits})) == wanted) return PixelFormat{PixelKind::Grey, bits};
    for (const auto pattern : {BayerPattern::RGGB, BayerPattern::GRBG, BayerPattern::GBRG, BayerPattern::BGGR}) {
      const PixelFormat format{PixelKind::Bayer, bits, pattern};
      if (upper(name_of(format)) == wanted) return format;
    }
  }
  return std::nullopt;
}

int mat_type(const PixelFormat& format) {
  switch (format.kind) {
    case PixelKind::Grey:
    case PixelKind::Bayer:
      return format.bits > 8 ? CV_16UC1 : CV_8UC1;
    case PixelKind::Bgr:
      return CV_8UC3;
    case PixelKind::Yuyv:
      return CV_8UC2;
    case PixelKind::Nv12:
      return CV_8UC1;
    case PixelKind::Jpeg:
      break;
  }
  throw std::invalid_argument("mat_type: a JPEG's length varies");
}

cv::Size mat_size(const PixelFormat& format, cv::Size size) {
  if (format.kind == PixelKind::Jpeg) throw std::invalid_argument("mat_size: a JPEG's length varies");
  return format.kind == PixelKind::Nv12 ? cv::Size(size.width, size.height * 3 / 2) : size;
}

}  // namespace alidade
