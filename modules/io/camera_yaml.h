// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include <yaml-cpp/yaml.h>

#include "io/camera_records.h"

namespace alidade {

/// A camera of our YAML, wherever it stands in a file: the map under `camera:`. `index` names it where it has no name.
/// Throws InputError for a key or model that is not known, one that is missing, and what is no number.
CameraRecord read_camera_node(const std::filesystem::path& path, const YAML::Node& node, std::size_t index);

}  // namespace alidade
