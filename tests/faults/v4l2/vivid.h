// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "capture/camera_device.h"
#include "capture/v4l2/v4l2_device.h"

// The cameras of the virtual machine (scripts/test-v4l2-vm), made by the kernel's driver vivid.
namespace alidade::test {

inline constexpr const char* kWebcam = "/dev/video0";
inline constexpr const char* kMultiplanar = "/dev/video1";  ///< a webcam too
inline constexpr const char* kLoopInput = "/dev/video2";    ///< HDMI, which shows what goes out at
inline constexpr const char* kLoopOutput = "/dev/video3";

/// Whether this program runs in that machine.
bool has_vivid();

/// The number in the environment variable, or `fallback`.
int parameter(const char* name, int fallback);

/// Sets a control of vivid, as the driver or a user might at any moment, through an opening of its own.
void set_control(const std::string& path, std::string_view name, std::string_view value);

/// What a camera is asked for: the smallest size, which the emulated processor can fill in time.
CameraRequest small_request(double fps_hz = 30);

/// An image of the camera with that format, after its first ones.
cv::Mat image_in_format(const std::string& path, const std::string& format);

/// Resources of this program.
int open_descriptors();
int resident_kb();

/// Takes back what a test may have changed, at its end however it ends.
class WebcamReset {
 public:
  WebcamReset() = default;
  ~WebcamReset();
  WebcamReset(const WebcamReset&) = delete;
  WebcamReset& operator=(const WebcamReset&) = delete;
};

}  // namespace alidade::test
