// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "capture/pixel_format.h"

namespace alidade {

/// How far the bytes of a V4L2 format are from those of a Frame.
enum class V4l2Packing {
  Plain,      ///< as they are
  Uyvy,       ///< chroma before luma
  Rgb,        ///< red before blue
  BigEndian,  ///< the upper byte first
  Mipi10,     ///< four values' upper eight bits, then a byte with the lower two of each
};

/// A V4L2 pixel format that we can take.
struct V4l2Format {
  std::uint32_t code = 0;  ///< V4L2_PIX_FMT_...
  PixelFormat pixels;
  V4l2Packing packing = V4l2Packing::Plain;
};

/// All of them, what serves tracking best first: methods look at 8-bit luma, so grey, then luma at full resolution with
/// colour beside it, then what loses sharpness (a mosaic) or must be cut to 8 bits, and last what was compressed with
/// losses. The formats before JPEG are free of loss.
std::span<const V4l2Format> v4l2_formats();

/// The format of that code; null where we cannot take it.
const V4l2Format* find_v4l2_format(std::uint32_t code);

/// The four characters of a code ("YUYV"), without blanks at the end ("Y10"), "-BE" behind where it is big-endian.
std::string v4l2_format_name(std::uint32_t code);

/// The code of such a name; lower case will do where upper case is meant. Empty where it is longer than 4 characters.
std::optional<std::uint32_t> parse_v4l2_format_name(std::string_view name);

/// Bytes of a row, without padding: of the luma for NV12. Not for JPEG (std::invalid_argument).
std::size_t v4l2_row_bytes(const V4l2Format& format, int width_px);

}  // namespace alidade
