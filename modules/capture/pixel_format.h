// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <opencv2/core/types.hpp>

namespace alidade {

/// How the values of an image lie in memory. In `Frame::image` of w × h px:
enum class PixelKind {
  Grey,   ///< h rows of w values: CV_8UC1, or CV_16UC1 where a value has more than 8 bits (in the low bits)
  Bayer,  ///< as Grey, behind a mosaic of colours
  Bgr,    ///< CV_8UC3
  Yuyv,   ///< CV_8UC2: luma, and in turn blue and red difference (YUV 4:2:2)
  Nv12,   ///< CV_8UC1 of 3h/2 rows: luma, then the two differences at half the resolution (YUV 4:2:0)
  Jpeg,   ///< CV_8UC1, one row: the bytes of a JPEG image
};

/// The colours of the first two pixels of the first two rows of a Bayer mosaic.
enum class BayerPattern { RGGB, GRBG, GBRG, BGGR };

/// What the values of an image mean. Devices that pack values more tightly, or send RGB, are unpacked or swapped into
/// one of these when the frame is taken; no bit of a value is lost by that.
struct PixelFormat {
  PixelKind kind = PixelKind::Grey;
  int bits = 8;                               ///< of a value: 8, 10, 12, 14 or 16
  BayerPattern pattern = BayerPattern::RGGB;  ///< of a Bayer image

  friend bool operator==(const PixelFormat& a, const PixelFormat& b) {
    return a.kind == b.kind && a.bits == b.bits && (a.kind != PixelKind::Bayer || a.pattern == b.pattern);
  }
};

/// As GenICam's naming convention (PFNC) has it where it has one: "Mono8", "Mono12", "BayerRG8", "BGR8"; else "YUYV",
/// "NV12", "JPEG".
std::string name_of(const PixelFormat& format);

/// The format of that name, in upper or lower case; empty where there is none.
std::optional<PixelFormat> parse_pixel_format(std::string_view name);

/// The type and size of `Frame::image` for an image of `size` px. Not for JPEG, whose length varies
/// (std::invalid_argument).
int mat_type(const PixelFormat& format);
cv::Size mat_size(const PixelFormat& format, cv::Size size);

}  // namespace alidade
