// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/pfnc_format.h"

#include <algorithm>
#include <array>

namespace alidade {
namespace {

using enum WireLayout;

constexpr PixelFormat grey(int bits) {
  return {PixelKind::Grey, bits, BayerPattern::RGGB};
}

constexpr PixelFormat bayer(BayerPattern pattern, int bits) {
  return {PixelKind::Bayer, bits, pattern};
}

constexpr PixelFormat colour(PixelKind kind) {
  return {kind, 8, BayerPattern::RGGB};
}

constexpr BayerPattern kRg = BayerPattern::RGGB, kGr = BayerPattern::GRBG;
constexpr BayerPattern kGb = BayerPattern::GBRG, kBg = BayerPattern::BGGR;

// The first entry of a code is its name today; names that older cameras give the same code come after.
constexpr std::array kFormats{
    PfncFormat{0x01080001, "Mono8", Bytes, grey(8)},
    PfncFormat{0x01100003, "Mono10", Words, grey(10)},
    PfncFormat{0x010C0004, "Mono10Packed", GevPacked10, grey(10)},
    PfncFormat{0x010A0046, "Mono10p", LsbPacked10, grey(10)},
    PfncFormat{0x01100005, "Mono12", Words, grey(12)},
    PfncFormat{0x010C0006, "Mono12Packed", GevPacked12, grey(12)},
    PfncFormat{0x010C0047, "Mono12p", LsbPacked12, grey(12)},
    PfncFormat{0x01100025, "Mono14", Words, grey(14)},
    PfncFormat{0x01100007, "Mono16", Words, grey(16)},
    PfncFormat{0x01080008, "BayerGR8", Bytes, bayer(kGr, 8)},
    PfncFormat{0x01080009, "BayerRG8", Bytes, bayer(kRg, 8)},
    PfncFormat{0x0108000A, "BayerGB8", Bytes, bayer(kGb, 8)},
    PfncFormat{0x0108000B, "BayerBG8", Bytes, bayer(kBg, 8)},
    PfncFormat{0x0110000C, "BayerGR10", Words, bayer(kGr, 10)},
    PfncFormat{0x0110000D, "BayerRG10", Words, bayer(kRg, 10)},
    PfncFormat{0x0110000E, "BayerGB10", Words, bayer(kGb, 10)},
    PfncFormat{0x0110000F, "BayerBG10", Words, bayer(kBg, 10)},
    PfncFormat{0x01100010, "BayerGR12", Words, bayer(kGr, 12)},
    PfncFormat{0x01100011, "BayerRG12", Words, bayer(kRg, 12)},
    PfncFormat{0x01100012, "BayerGB12", Words, bayer(kGb, 12)},
    PfncFormat{0x01100013, "BayerBG12", Words, bayer(kBg, 12)},
    PfncFormat{0x0110002E, "BayerGR16", Words, bayer(kGr, 16)},
    PfncFormat{0x0110002F, "BayerRG16", Words, bayer(kRg, 16)},
    PfncFormat{0x01100030, "BayerGB16", Words, bayer(kGb, 16)},
    PfncFormat{0x01100031, "BayerBG16", Words, bayer(kBg, 16)},
    PfncFormat{0x010C0026, "BayerGR10Packed", GevPacked10, bayer(kGr, 10)},
    PfncFormat{0x010C0027, "BayerRG10Packed", GevPacked10, bayer(kRg, 10)},
    PfncFormat{0x010C0028, "BayerGB10Packed", GevPacked10, bayer(kGb, 10)},
    PfncFormat{0x010C0029, "BayerBG10Packed", GevPacked10, bayer(kBg, 10)},
    PfncFormat{0x010C002A, "BayerGR12Packed", GevPacked12, bayer(kGr, 12)},
    PfncFormat{0x010C002B, "BayerRG12Packed", GevPacked12, bayer(kRg, 12)},
    PfncFormat{0x010C002C, "BayerGB12Packed", GevPacked12, bayer(kGb, 12)},
    PfncFormat{0x010C002D, "BayerBG12Packed", GevPacked12, bayer(kBg, 12)},
    PfncFormat{0x010A0056, "BayerGR10p", LsbPacked10, bayer(kGr, 10)},
    PfncFormat{0x010A0058, "BayerRG10p", LsbPacked10, bayer(kRg, 10)},
    PfncFormat{0x010A0054, "BayerGB10p", LsbPacked10, bayer(kGb, 10)},
    PfncFormat{0x010A0052, "BayerBG10p", LsbPacked10, bayer(kBg, 10)},
    PfncFormat{0x010C0057, "BayerGR12p", LsbPacked12, bayer(kGr, 12)},
    PfncFormat{0x010C0059, "BayerRG12p", LsbPacked12, bayer(kRg, 12)},
    PfncFormat{0x010C0055, "BayerGB12p", LsbPacked12, bayer(kGb, 12)},
    PfncFormat{0x010C0053, "BayerBG12p", LsbPacked12, bayer(kBg, 12)},
    PfncFormat{0x02180014, "RGB8", Rgb, colour(PixelKind::Bgr)},
    PfncFormat{0x02180014, "RGB8Packed", Rgb, colour(PixelKind::Bgr)},
    PfncFormat{0x02180015, "BGR8", Bgr, colour(PixelKind::Bgr)},
    PfncFormat{0x02180015, "BGR8Packed", Bgr, colour(PixelKind::Bgr)},
    PfncFormat{0x02100032, "YUV422_8", YuyvBytes, colour(PixelKind::Yuyv)},
    PfncFormat{0x02100032, "YUV422_YUYV_Packed", YuyvBytes, colour(PixelKind::Yuyv)},
    PfncFormat{0x0210003B, "YCbCr422_8", YuyvBytes, colour(PixelKind::Yuyv)},
    PfncFormat{0x0210001F, "YUV422_8_UYVY", UyvyBytes, colour(PixelKind::Yuyv)},
    PfncFormat{0x0210001F, "YUV422Packed", UyvyBytes, colour(PixelKind::Yuyv)},
    PfncFormat{0x02100043, "YCbCr422_8_CbYCrY", UyvyBytes, colour(PixelKind::Yuyv)},
};

template <typename Predicate>
std::optional<PfncFormat> first_where(Predicate predicate) {
  const auto* const found = std::find_if(kFormats.begin(), kFormats.end(), predicate);
  return found == kFormats.end() ? std::nullopt : std::optional(*found);
}

}  // namespace

std::optional<PfncFormat> pfnc_format(std::uint32_t code) {
  return first_where([code](const PfncFormat& format) { return format.code == code; });
}

std::optional<PfncFormat> pfnc_format(std::string_view name) {
  return first_where([name](const PfncFormat& format) { return format.name == name; });
}

std::size_t wire_bytes(const PfncFormat& format, std::size_t pixels) {
  const std::size_t bits = (format.code >> 16) & 0xFF;  // the code tells how many a pixel takes
  return (pixels * bits + 7) / 8;
}

}  // namespace alidade
