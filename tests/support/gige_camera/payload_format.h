// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include <opencv2/core/mat.hpp>

#include "capture/pixel_format.h"
#include "tests/support/gige_camera/big_endian.h"

namespace alidade::test {

/// How the values of an image lie in what a camera sends.
enum class Packing {
  Whole,    ///< each value in whole bytes, the lower first
  Packed,   ///< GigE Vision's "Packed": two values of 10 or 12 bits in three bytes
  Seamless  ///< GenICam's "p": bit behind bit, the lowest first
};

/// A format of the camera: its name and number in GenICam's PFNC, and how we lay it out.
struct PayloadFormat {
  std::string_view name;
  std::uint32_t number = 0;
  PixelFormat pixel;
  Packing packing = Packing::Whole;
  bool is_rgb = false;  ///< red first; ours is blue first
};

/// All that the camera offers.
std::span<const PayloadFormat> payload_formats();

/// Empty where the camera does not offer it.
std::optional<PayloadFormat> find_payload_format(std::string_view name);
std::optional<PayloadFormat> find_payload_format(std::uint32_t number);

/// Bytes of an image of `size` px.
std::size_t payload_size(const PayloadFormat& format, cv::Size size);

/// The bytes that the camera sends of `image` (laid out as format.pixel says), into the first payload_size() of
/// `payload`.
void write_payload(const cv::Mat& image, const PayloadFormat& format, std::span<std::uint8_t> payload);

}  // namespace alidade::test
