// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "capture/genicam/aravis_objects.h"

namespace alidade {

/// How a camera is reached.
struct OpenedCamera {
  GObjectPointer<ArvCamera> camera;
  std::string address;  ///< IPv4, of a GigE Vision camera; else empty
};

/// The camera of that network address, serial number or id, under our control. An address is asked directly (0.6 s at
/// most); anything else is looked for by broadcast and on the USB (1 to 2 s). Throws CameraError.
OpenedCamera open_camera(const std::string& id, const std::string& source);

/// The IPv4 address that `id` is, or the name of a host that has one; empty for anything else.
std::string address_of(const std::string& id);

}  // namespace alidade
