// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "capture/recording/recording_writer.h"

namespace alidade::test {

/// Every kind of image that a camera gives.
std::vector<PixelFormat> all_pixel_formats();

/// A camera of 25 frames per second that is not there.
RecordingSubject synthetic_camera(const PixelFormat& format, cv::Size size);

/// Its frame `index`: noise of its own in every bit of the format, over a ramp; with times and a sequence number.
Frame synthetic_frame(const RecordingSubject& camera, int index);

/// Whether pixels, format, times and stamp are the same.
bool are_same(const Frame& a, const Frame& b);

}  // namespace alidade::test
