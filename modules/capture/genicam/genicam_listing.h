// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "capture/camera_listing.h"

namespace alidade {

/// What the GenICam cameras that answer a broadcast, or are on the USB, offer; takes 1 to 2 s. Cameras on this
/// machine's own loopback and in other networks do not hear it. One that cannot be asked bears its `trouble`.
std::vector<ListedCamera> list_genicam();

/// What the camera of that network address, serial number or id offers. Throws CameraError where none answers; one that
/// another program controls bears that as its `trouble`.
ListedCamera describe_genicam(const std::string& id);

}  // namespace alidade
