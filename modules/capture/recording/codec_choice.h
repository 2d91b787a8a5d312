// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "capture/recording/recorder_options.h"

namespace alidade {

/// The codec for frames of a camera, one each `period`: FFV1 (the smallest file) where packing one takes less than
/// options.busy_share of the period on this machine, as busy as it is now; else ffvhuff likewise; else raw. Measured on
/// a part of a noisy image, noisier than a camera's, so that a first frame in the dark does not mislead. JPEG: raw.
/// Takes about a frame time.
LosslessCodec choose_codec(PixelLayout layout, cv::Size size, std::chrono::nanoseconds period,
                           const RecorderOptions& options);

}  // namespace alidade
