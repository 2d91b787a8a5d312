// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "capture/genicam/aravis_objects.h"

namespace alidade {

/// Sets the size of a GigE Vision camera's packets, bytes: the one wanted, or the largest that comes through. Cameras
/// that cannot send test packets keep theirs, except on this machine's own loopback, where any size up to its MTU
/// comes through. Throws CameraError for a size that the camera refuses.
void choose_packet_size(ArvCamera* camera, const std::string& address, std::optional<int> wanted_bytes,
                        const std::string& source);

}  // namespace alidade
