// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "capture/camera_device.h"

namespace alidade {

/// Opens and starts the GenICam camera (GigE Vision, USB3 Vision) of that network address, serial number or id, through
/// Aravis. Throws CameraError: no answer, controlled by another program, a feature that it has not or refuses.
std::unique_ptr<CameraDevice> open_genicam(const std::string& id, const CameraRequest& request);

}  // namespace alidade
