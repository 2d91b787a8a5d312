// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "capture/camera_device.h"

namespace alidade {

/// Opens and starts the capture device of that path (/dev/video0, or its lasting name under /dev/v4l) by the kernel's
/// own interface. Throws CameraError: no such device, no permission, in use, no capture device, nothing like the
/// request granted.
std::unique_ptr<CameraDevice> open_v4l2(const std::string& path, const CameraRequest& request);

}  // namespace alidade
