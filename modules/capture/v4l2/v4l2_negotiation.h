// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "capture/camera_device.h"
#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_formats.h"

namespace alidade {

/// What a device will send, as its driver granted it.
struct V4l2Grant {
  const V4l2Format* format = nullptr;
  cv::Size size;                                   ///< px
  std::vector<std::size_t> strides;                ///< bytes from row to row, of each plane in memory of its own
  std::optional<std::chrono::nanoseconds> period;  ///< empty where the driver does not tell
};

/// Throws CameraError (Busy) where another program streams from the device.
void require_idle(const V4l2Device& device);

/// Sets format, size, place of the region and rate as requested; which format is taken where none is requested says
/// preferred() in v4l2_choice.h. A rate that is not offered becomes the nearest one; a format, size or region that is
/// not granted throws CameraError (Refused), naming what is offered.
V4l2Grant negotiate(const V4l2Device& device, const CameraRequest& request);

}  // namespace alidade
