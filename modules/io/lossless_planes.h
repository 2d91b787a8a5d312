// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "io/lossless_format.h"

struct AVFrame;

namespace alidade {

/// libav's pixel format (AVPixelFormat) in which a codec takes a layout; of raw, the layout's own.
int libav_format(PixelLayout layout, LosslessCodec codec);

/// Moves the values of an image into the planes of a frame of libav_format(), of a codec that is not raw.
void to_planes(const cv::Mat& image, PixelLayout layout, AVFrame& frame);

/// And back. A decoder may give another pixel format than its encoder took.
bool is_from_planes(int decoded, PixelLayout layout);
cv::Mat from_planes(const AVFrame& frame, PixelLayout layout);

}  // namespace alidade
