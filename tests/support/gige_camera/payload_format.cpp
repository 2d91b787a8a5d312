// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/payload_format.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace alidade::test {
namespace {

constexpr PixelFormat grey(int bits) {
  return {.kind = PixelKind::Grey, .bits = bits};
}
constexpr PixelFormat bayer(BayerPattern pattern, int bits) {
  return {.kind = PixelKind::Bayer, .bits = bits, .pattern = pattern};
}
constexpr PixelFormat kBgr{.kind = PixelKind::Bgr, .bits = 8};

using enum BayerPattern;

// Source: EMVA, Pixel Format Naming Convention, "PixelFormatValues"; bits 16 to 23 are the bits per pixel.
constexpr std::array kFormats{
    PayloadFormat{.name = "Mono8", .number = 0x01080001, .pixel = grey(8)},
    PayloadFormat{.name = "Mono10", .number = 0x01100003, .pixel = grey(10)},
    PayloadFormat{.name = "Mono10Packed", .number = 0x010c0004, .pixel = grey(10), .packing = Packing::Packed},
    PayloadFormat{.name = "Mono10p", .number = 0x010a0046, .pixel = grey(10), .packing = Packing::Seamless},
    PayloadFormat{.name = "Mono12", .number = 0x01100005, .pixel = grey(12)},
    PayloadFormat{.name = "Mono12Packed", .number = 0x010c0006, .pixel = grey(12), .packing = Packing::Packed},
    PayloadFormat{.name = "Mono12p", .number = 0x010c0047, .pixel = grey(12), .packing = Packing::Seamless},
    PayloadFormat{.name = "Mono14", .number = 0x01100025, .pixel = grey(14)},
    PayloadFormat{.name = "Mono16", .number = 0x01100007, .pixel = grey(16)},
    PayloadFormat{.name = "BayerGR8", .number = 0x01080008, .pixel = bayer(GRBG, 8)},
    PayloadFormat{.name = "BayerRG8", .number = 0x01080009, .pixel = bayer(RGGB, 8)},
    PayloadFormat{.name = "BayerGB8", .number = 0x0108000a, .pixel = bayer(GBRG, 8)},
    PayloadFormat{.name = "BayerBG8", .number = 0x0108000b, .pixel = bayer(BGGR, 8)},
    PayloadFormat{.name = "BayerRG12", .number = 0x01100011, .pixel = bayer(RGGB, 12)},
    PayloadFormat{
        .name = "BayerRG12Packed", .number = 0x010c002b, .pixel = bayer(RGGB, 12), .packing = Packing::Packed},
    PayloadFormat{.name = "RGB8", .number = 0x02180014, .pixel = kBgr, .is_rgb = true},
    PayloadFormat{.name = "BGR8", .number = 0x02180015, .pixel = kBgr},
};

template <typename Predicate>
std::optional<PayloadFormat> find_if(Predicate predicate) {
  const auto* const found = std::find_if(kFormats.begin(), kFormats.end(), predicate);
  return found == kFormats.end() ? std::nullopt : std::optional(*found);
}

// Two values in three bytes: the upper eight bits of the first, the lower bits of both (of the first in the lower half
// of the byte), the upper eight bits of the second.
void write_packed(std::span<const std::uint16_t> values, int bits, std::span<std::uint8_t> payload) {
  const int low = bits - 8;
  const unsigned mask = (1U << static_cast<unsigned>(low)) - 1U;
  std::size_t at = 0;
  for (std::size_t i = 0; i < values.size(); i += 2) {
    const unsigned first = values[i];
    const unsigned second = i + 1 < values.size() ? values[i + 1] : 0;
    payload[at++] = static_cast<std::uint8_t>(first >> low);
    payload[at++] = static_cast<std::uint8_t>((first & mask) | (second & mask) << 4U);
    if (i + 1 < values.size()) payload[at++] = static_cast<std::uint8_t>(second >> low);
  }
}

void write_seamless(std::span<const std::uint16_t> values, int bits, std::span<std::uint8_t> payload) {
  std::uint32_t pending = 0;
  int pending_bits = 0;
  std::size_t at = 0;
  for (const std::uint16_t value : values) {
    pending |= static_cast<std::uint32_t>(value) << pending_bits;
    pending_bits += bits;
    for (; pending_bits >= 8; pending_bits -= 8, pending >>= 8U) payload[at++] = static_cast<std::uint8_t>(pending);
  }
  if (pending_bits > 0) payload[at] = static_cast<std::uint8_t>(pending);
}

void swap_red_and_blue(std::span<std::uint8_t> payload) {
  for (std::size_t i = 0; i + 2 < payload.size(); i += 3) std::swap(payload[i], payload[i + 2]);
}

}  // namespace

std::span<const PayloadFormat> payload_formats() {
  return kFormats;
}

std::optional<PayloadFormat> find_payload_format(std::string_view name) {
  return find_if([name](const PayloadFormat& format) { return format.name == name; });
}

std::optional<PayloadFormat> find_payload_format(std::uint32_t number) {
  return find_if([number](const PayloadFormat& format) { return format.number == number; });
}

std::size_t payload_size(const PayloadFormat& format, cv::Size size) {
  const std::size_t bits_per_pixel = (format.number >> 16U) & 0xffU;
  return (static_cast<std::size_t>(size.area()) * bits_per_pixel + 7) / 8;
}

void write_payload(const cv::Mat& image, const PayloadFormat& format, std::span<std::uint8_t> payload) {
  const cv::Mat whole = image.isContinuous() ? image : image.clone();
  payload = payload.first(payload_size(format, image.size()));
  if (format.packing == Packing::Whole) {  // this machine has the lower byte first too
    std::memcpy(payload.data(), whole.data, payload.size());
    if (format.is_rgb) swap_red_and_blue(payload);
    return;
  }
  const std::span values(whole.ptr<std::uint16_t>(), whole.total());
  if (format.packing == Packing::Packed) write_packed(values, format.pixel.bits, payload);
  if (format.packing == Packing::Seamless) write_seamless(values, format.pixel.bits, payload);
}

}  // namespace alidade::test
