// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <opencv2/core/mat.hpp>

#include "capture/v4l2/v4l2_formats.h"

namespace alidade {

/// A plane of an image in a driver's buffer: what was filled, and from one row to the next.
struct V4l2Plane {
  std::span<const std::uint8_t> bytes;
  std::size_t stride = 0;  ///< bytes; may exceed what a row needs
};

/// The image in `planes`, copied, as Frame::image has it: one plane, or two for NV12 (where one holds both, the
/// differences of colour follow the luma with the same stride). Empty where the planes hold less than the image.
cv::Mat v4l2_image(std::span<const V4l2Plane> planes, const V4l2Format& format, cv::Size size);

}  // namespace alidade
