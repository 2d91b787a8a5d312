// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <linux/videodev2.h>
#include <opencv2/core/types.hpp>

#include "capture/camera_listing.h"
#include "capture/v4l2/v4l2_device.h"

namespace alidade {

/// Formats of a capture device with sizes and rates, as its driver enumerates them; some drivers tell no sizes.
std::vector<ListedFormat> v4l2_offers(const V4l2Device& device);

/// Times between two frames that a device offers.
struct V4l2Periods {
  std::vector<v4l2_fract> values;  ///< s; of a range its two ends; empty where the driver does not tell
  bool is_range = false;
};

/// What the device offers for a format and size.
V4l2Periods v4l2_periods(const V4l2Device& device, std::uint32_t code, cv::Size size);

/// Frames per second of such a period; 0 where it is nonsense.
double rate_of(const v4l2_fract& period);

/// Formats that we can take and their sizes in words, those of equal sizes together: "YUYV, GREY at 640x480, 320x240".
std::string describe_offers(std::span<const ListedFormat> formats);

/// "640x480".
std::string size_text(cv::Size size);

}  // namespace alidade
