// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include <opencv2/core/mat.hpp>

#include "capture/recording/recorder_options.h"

namespace alidade {

/// The codec for frames like `image`, one each `period`: FFV1 (the smallest file) where packing it takes less than
/// options.busy_share of the period on this machine as busy as it is now, else ffvhuff likewise, else raw. Measured on
/// `image` and on noise (which takes longest), so that a first frame in the dark does not mislead. JPEG: raw.
/// Takes a few frame times.
LosslessCodec choose_codec(const cv::Mat& image, PixelLayout layout, cv::Size size, std::chrono::nanoseconds period,
                           const RecorderOptions& options);

}  // namespace alidade
