// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_formats.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <linux/videodev2.h>

namespace alidade {
namespace {

constexpr PixelFormat grey(int bits) {
  return {PixelKind::Grey, bits};
}

constexpr PixelFormat bayer(int bits, BayerPattern pattern) {
  return {PixelKind::Bayer, bits, pattern};
}

using enum V4l2Packing;
using enum BayerPattern;

constexpr std::array kFormats{
    V4l2Format{V4L2_PIX_FMT_GREY, grey(8)},
    V4l2Format{V4L2_PIX_FMT_YUYV, {PixelKind::Yuyv}},
    V4l2Format{V4L2_PIX_FMT_UYVY, {PixelKind::Yuyv}, Uyvy},
    V4l2Format{V4L2_PIX_FMT_NV12, {PixelKind::Nv12}},
    V4l2Format{V4L2_PIX_FMT_NV12M, {PixelKind::Nv12}},
    V4l2Format{V4L2_PIX_FMT_BGR24, {PixelKind::Bgr}},
    V4l2Format{V4L2_PIX_FMT_RGB24, {PixelKind::Bgr}, Rgb},
    V4l2Format{V4L2_PIX_FMT_Y10, grey(10)},
    V4l2Format{V4L2_PIX_FMT_Y10P, grey(10), Mipi10},
    V4l2Format{V4L2_PIX_FMT_Y12, grey(12)},
    V4l2Format{V4L2_PIX_FMT_Y14, grey(14)},
    V4l2Format{V4L2_PIX_FMT_Y16, grey(16)},
    V4l2Format{V4L2_PIX_FMT_Y16_BE, grey(16), BigEndian},
    V4l2Format{V4L2_PIX_FMT_SRGGB8, bayer(8, RGGB)},
    V4l2Format{V4L2_PIX_FMT_SGRBG8, bayer(8, GRBG)},
    V4l2Format{V4L2_PIX_FMT_SGBRG8, bayer(8, GBRG)},
    V4l2Format{V4L2_PIX_FMT_SBGGR8, bayer(8, BGGR)},
    V4l2Format{V4L2_PIX_FMT_SRGGB10, bayer(10, RGGB)},
    V4l2Format{V4L2_PIX_FMT_SGRBG10, bayer(10, GRBG)},
    V4l2Format{V4L2_PIX_FMT_SGBRG10, bayer(10, GBRG)},
    V4l2Format{V4L2_PIX_FMT_SBGGR10, bayer(10, BGGR)},
    V4l2Format{V4L2_PIX_FMT_SRGGB10P, bayer(10, RGGB), Mipi10},
    V4l2Format{V4L2_PIX_FMT_SGRBG10P, bayer(10, GRBG), Mipi10},
    V4l2Format{V4L2_PIX_FMT_SGBRG10P, bayer(10, GBRG), Mipi10},
    V4l2Format{V4L2_PIX_FMT_SBGGR10P, bayer(10, BGGR), Mipi10},
    V4l2Format{V4L2_PIX_FMT_SRGGB12, bayer(12, RGGB)},
    V4l2Format{V4L2_PIX_FMT_SGRBG12, bayer(12, GRBG)},
    V4l2Format{V4L2_PIX_FMT_SGBRG12, bayer(12, GBRG)},
    V4l2Format{V4L2_PIX_FMT_SBGGR12, bayer(12, BGGR)},
    V4l2Format{V4L2_PIX_FMT_SRGGB16, bayer(16, RGGB)},
    V4l2Format{V4L2_PIX_FMT_SGRBG16, bayer(16, GRBG)},
    V4l2Format{V4L2_PIX_FMT_SGBRG16, bayer(16, GBRG)},
    V4l2Format{V4L2_PIX_FMT_SBGGR16, bayer(16, BGGR)},
    V4l2Format{V4L2_PIX_FMT_MJPEG, {PixelKind::Jpeg}},
    V4l2Format{V4L2_PIX_FMT_JPEG, {PixelKind::Jpeg}},
};

constexpr std::uint32_t kBigEndian = 1u << 31;
constexpr std::string_view kBigEndianSuffix = "-BE";

std::uint32_t code_of(std::string_view characters) {
  std::uint32_t code = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const char character = i < characters.size() ? characters[i] : ' ';
    code |= static_cast<std::uint32_t>(static_cast<unsigned char>(character)) << (8 * i);
  }
  return code;
}

}  // namespace

std::span<const V4l2Format> v4l2_formats() {
  return kFormats;
}

const V4l2Format* find_v4l2_format(std::uint32_t code) {
  const auto found = std::find_if(kFormats.begin(), kFormats.end(), [&](const auto& f) { return f.code == code; });
  return found == kFormats.end() ? nullptr : &*found;
}

std::string v4l2_format_name(std::uint32_t code) {
  std::string name;
  for (int i = 0; i < 4; ++i) name += static_cast<char>((code >> (8 * i)) & 0x7f);
  name.erase(name.find_last_not_of(' ') + 1);
  return code & kBigEndian ? name.append(kBigEndianSuffix) : name;
}

std::optional<std::uint32_t> parse_v4l2_format_name(std::string_view name) {
  std::uint32_t flag = 0;
  if (name.ends_with(kBigEndianSuffix)) {
    flag = kBigEndian;
    name.remove_suffix(kBigEndianSuffix.size());
  }
  if (name.empty() || name.size() > 4) return std::nullopt;
  std::string upper(name);
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
  // Case matters in V4L2 ("pBAA" is not "PBAA"), so upper case is only tried where the name as it stands says nothing.
  const std::uint32_t as_given = code_of(name) | flag;
  const std::uint32_t as_upper = code_of(upper) | flag;
  return find_v4l2_format(as_given) || !find_v4l2_format(as_upper) ? as_given : as_upper;
}

std::size_t v4l2_row_bytes(const V4l2Format& format, int width_px) {
  if (format.packing == Mipi10) return static_cast<std::size_t>(width_px + 3) / 4 * 5;
  return static_cast<std::size_t>(width_px) * CV_ELEM_SIZE(mat_type(format.pixels));
}

}  // namespace alidade
