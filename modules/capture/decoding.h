// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include "capture/frame_source.h"

namespace alidade {

/// The image as methods take it: 8 bits, grey or BGR. Values of more bits are cut to their upper eight; a mosaic is
/// interpolated. Empty where a JPEG is damaged.
cv::Mat decode(const cv::Mat& image, const PixelFormat& format);

/// The frames of `source`, decoded. Damaged frames are left out and counted in dropped_before of the next;
/// `fault()` tells how many.
std::unique_ptr<FrameSource> decoded(std::unique_ptr<FrameSource> source);

}  // namespace alidade
