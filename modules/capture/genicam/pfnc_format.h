// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "capture/pixel_format.h"

namespace alidade {

/// How a GenICam camera lays the values of an image onto the wire.
enum class WireLayout {
  Bytes,        ///< a byte each
  Words,        ///< two bytes each, the low one first
  GevPacked10,  ///< two values in three bytes: upper eight bits, lower bits of both, upper eight bits (GigE Vision)
  GevPacked12,  ///< the same for 12 bits
  LsbPacked10,  ///< a stream of bits, the lowest first: four values in five bytes (PFNC "p")
  LsbPacked12,  ///< the same for 12 bits: two values in three bytes
  Rgb,          ///< three bytes a pixel, red first
  Bgr,          ///< three bytes a pixel, blue first
  YuyvBytes,    ///< luma first (YUV422_8)
  UyvyBytes,    ///< blue difference first (YUV422_8_UYVY)
};

/// A pixel format of GenICam's naming convention that we can read.
struct PfncFormat {
  std::uint32_t code = 0;  ///< as in the headers of a stream and the values of PixelFormat
  std::string_view name;   ///< "Mono12Packed"
  WireLayout layout = WireLayout::Bytes;
  PixelFormat format;  ///< once unpacked
};

/// The format of that code; empty where we cannot read it.
/// Source: EMVA/AIA Pixel Format Naming Convention 2.3 and its table of values.
std::optional<PfncFormat> pfnc_format(std::uint32_t code);

/// The format of that name, as cameras spell it; empty where we cannot read it.
std::optional<PfncFormat> pfnc_format(std::string_view name);

/// Bytes of `pixels` consecutive pixels, the last byte filled up.
std::size_t wire_bytes(const PfncFormat& format, std::size_t pixels);

}  // namespace alidade
