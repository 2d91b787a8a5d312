// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

namespace alidade {

/// A size that a camera offers in a format, with its frame rates.
struct ListedSize {
  cv::Size size;                    ///< px; the largest where a range is offered
  std::optional<cv::Size> least{};  ///< the smallest, where a range is offered
  std::vector<double> fps_hz;       ///< offered rates, falling; of a range its two ends
};

struct ListedFormat {
  std::string name;          ///< the device's own: "YUYV", "Mono12Packed"
  std::string description;   ///< in words, where it has any
  bool is_readable = false;  ///< we can take it
  std::vector<ListedSize> sizes;
};

/// A control (V4L2) or feature (GenICam) that can be set by name.
struct ListedControl {
  std::string name;   ///< as --set takes it
  std::string kind;   ///< "integer", "float", "boolean", "choice", "command", "text"
  std::string value;  ///< now; empty where it cannot be read
  std::string range;  ///< "0 to 255 by 1"; empty where there is none
  std::vector<std::string> choices;
  std::string unit;  ///< empty where it has none
  bool is_writable = true;
};

/// What a camera offers.
struct ListedCamera {
  std::string source;                ///< what to give as SOURCE: "v4l2:/dev/video0"
  std::vector<std::string> aliases;  ///< other names of it that last: "v4l2:/dev/v4l/by-id/..."
  std::string model, serial, driver;
  std::vector<ListedFormat> formats;
  std::vector<ListedControl> controls;
  std::string trouble;  ///< why it could not be asked ("in use"); empty where all is well
};

}  // namespace alidade
