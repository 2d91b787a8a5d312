// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <opencv2/core/mat.hpp>

#include "capture/pixel_format.h"

namespace alidade::test {

/// Picture `number` of the generated sequence: noise that moves from picture to picture, so that a part of another
/// picture never looks right, with the number spelt in the first pixels of the first row where the row holds at least
/// kNumberPixels. Laid out as `format` says (Grey, Bayer or Bgr), `size` in px.
cv::Mat test_pattern(std::uint32_t number, cv::Size size, const PixelFormat& format);

/// Bits of the number, one pixel each, the highest first: none or all of the value's range.
constexpr int kNumberPixels = 32;

/// The number spelt in `image`; empty where it is too narrow.
std::optional<std::uint32_t> number_in_pattern(const cv::Mat& image, const PixelFormat& format);

}  // namespace alidade::test
