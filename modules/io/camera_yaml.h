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

/// The same with the keys of a camera on a rig (see rig_file.h).
CameraRecord read_rig_camera_node(const std::filesystem::path& path, const YAML::Node& node, std::size_t index);

/// The one or two cameras of OpenCV's or ROS' YAML; empty where no camera matrix is in it. The second is the right
/// camera of a stereo pair, posed by R and T.
CameraRecords read_opencv_yaml(const std::filesystem::path& path, const YAML::Node& root);

/// The cameras cam0, cam1, ... of Kalibr's camchain.
CameraRecords read_kalibr_chain(const std::filesystem::path& path, const YAML::Node& root);

}  // namespace alidade
