// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/pixel_unpacking.h"

#include <cstring>

namespace alidade {
namespace {

// Two values of three bytes; `split` tells the two layouts apart.
struct Pair {
  std::uint16_t first, second;
};

template <WireLayout kLayout>
Pair two_of_three(const std::uint8_t* b) {
  if constexpr (kLayout == WireLayout::GevPacked10) {
    return {static_cast<std::uint16_t>(b[0] << 2 | (b[1] & 0x3)),
            static_cast<std::uint16_t>(b[2] << 2 | (b[1] >> 4 & 0x3))};
  } else if constexpr (kLayout == WireLayout::GevPacked12) {
    return {static_cast<std::uint16_t>(b[0] << 4 | (b[1] & 0xF)), static_cast<std::uint16_t>(b[2] << 4 | b[1] >> 4)};
  } else {
    return {static_cast<std::uint16_t>(b[0] | (b[1] & 0xF) << 8), static_cast<std::uint16_t>(b[1] >> 4 | b[2] << 4)};
  }
}

template <WireLayout kLayout>
void unpack_pairs(const std::uint8_t* in, std::uint16_t* out, std::size_t count) {
  std::size_t i = 0;
  for (; i + 1 < count; i += 2, in += 3) {
    const Pair pair = two_of_three<kLayout>(in);
    out[i] = pair.first;
    out[i + 1] = pair.second;
  }
  if (i < count) {  // the last of an odd number takes but two bytes
    const std::uint8_t last[3] = {in[0], in[1], 0};
    out[i] = two_of_three<kLayout>(last).first;
  }
}

void unpack_lsb10(const std::uint8_t* in, std::uint16_t* out, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t bit = 10 * i;
    const std::uint8_t* const at = in + bit / 8;
    out[i] = static_cast<std::uint16_t>((at[0] | at[1] << 8) >> bit % 8 & 0x3FF);
  }
}

void swap_outer(const std::uint8_t* in, std::uint8_t* out, std::size_t pixels) {
  for (std::size_t i = 0; i < pixels; ++i, in += 3, out += 3) {
    out[0] = in[2];
    out[1] = in[1];
    out[2] = in[0];
  }
}

void swap_pairs(const std::uint8_t* in, std::uint8_t* out, std::size_t bytes) {
  for (std::size_t i = 0; i + 1 < bytes; i += 2) {
    out[i] = in[i + 1];
    out[i + 1] = in[i];
  }
}

void unpack(const std::uint8_t* in, const PfncFormat& format, std::uint8_t* out, std::size_t pixels) {
  auto* const words = reinterpret_cast<std::uint16_t*>(out);
  switch (format.layout) {
    case WireLayout::Bytes:
    case WireLayout::Words:  // little endian, as are the machines that we build for
    case WireLayout::Bgr:
    case WireLayout::YuyvBytes:
      std::memcpy(out, in, wire_bytes(format, pixels));
      return;
    case WireLayout::GevPacked10:
      return unpack_pairs<WireLayout::GevPacked10>(in, words, pixels);
    case WireLayout::GevPacked12:
      return unpack_pairs<WireLayout::GevPacked12>(in, words, pixels);
    case WireLayout::LsbPacked10:
      return unpack_lsb10(in, words, pixels);
    case WireLayout::LsbPacked12:
      return unpack_pairs<WireLayout::LsbPacked12>(in, words, pixels);
    case WireLayout::Rgb:
      return swap_outer(in, out, pixels);
    case WireLayout::UyvyBytes:
      return swap_pairs(in, out, 2 * pixels);
  }
}

}  // namespace

std::size_t wire_image_bytes(const PfncFormat& format, cv::Size size, std::size_t row_padding) {
  const auto width = static_cast<std::size_t>(size.width), height = static_cast<std::size_t>(size.height);
  if (row_padding == 0) return wire_bytes(format, width * height);
  return height * (wire_bytes(format, width) + row_padding);
}

cv::Mat unpack_image(std::span<const std::uint8_t> bytes, const PfncFormat& format, cv::Size size,
                     std::size_t row_padding) {
  if (bytes.size() < wire_image_bytes(format, size, row_padding)) return {};
  cv::Mat image(size, mat_type(format.format));
  if (row_padding == 0) {
    unpack(bytes.data(), format, image.data, image.total());
    return image;
  }
  const std::size_t stride = wire_bytes(format, static_cast<std::size_t>(size.width)) + row_padding;
  for (int row = 0; row < size.height; ++row) {
    unpack(bytes.data() + static_cast<std::size_t>(row) * stride, format, image.ptr(row),
           static_cast<std::size_t>(size.width));
  }
  return image;
}

}  // namespace alidade
