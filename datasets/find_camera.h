// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "camera/camera.h"

namespace alidade {

/// The camera file `name` in `folder` or the folder above it, for images of the size of `image`; empty where there is
/// none.
std::optional<Camera> find_camera(const std::filesystem::path& folder, const char* name,
                                  const std::filesystem::path& image);

}  // namespace alidade
