// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "capture/camera_listing.h"

namespace alidade {

/// The capture devices of this machine, in the order of their numbers, with what they offer. One that cannot be opened
/// is listed with its trouble. `folder`: where the device nodes are.
std::vector<ListedCamera> list_v4l2(const std::filesystem::path& folder = "/dev");

}  // namespace alidade
