// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <opencv2/core/mat.hpp>

#include "capture/genicam/pfnc_format.h"

namespace alidade {

/// Bytes that an image of `size` px takes on the wire. Without padding the rows of a packed format follow each other
/// without a gap, even within a byte; with `row_padding` bytes after each row every row starts at a byte of its own.
std::size_t wire_image_bytes(const PfncFormat& format, cv::Size size, std::size_t row_padding = 0);

/// The image as pixel_format.h describes `format.format`, copied out of `bytes`. Empty where there are too few.
cv::Mat unpack_image(std::span<const std::uint8_t> bytes, const PfncFormat& format, cv::Size size,
                     std::size_t row_padding = 0);

}  // namespace alidade
