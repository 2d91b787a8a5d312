// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "capture/camera_listing.h"

namespace alidade {

/// All cameras that this machine and its networks show, V4L2 before GenICam.
std::vector<ListedCamera> list_cameras();

/// The cameras of these names, found or not in list_cameras. Throws InputError for a name that is no camera's,
/// CameraError for a camera that does not answer.
std::vector<ListedCamera> describe_cameras(const std::vector<std::string>& sources);

}  // namespace alidade
