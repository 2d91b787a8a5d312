// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "geometry/point_map.h"

namespace alidade {

/// Writes the points of a map as a binary PLY: position, colour, covariance (upper triangle) and SIFT descriptor of
/// each, frame and units in its comments. Keyframes are not part of it; write_colmap_model keeps them.
/// Throws DeviceError where the file system refuses.
void write_map_ply(const std::filesystem::path& path, const PointMap& map);

/// Reads the points of write_map_ply, exactly, or the vertices of another PLY (ASCII or little-endian binary, a cloud
/// or a mesh); what a file lacks of colour, covariance and descriptor stays as in MapPoint{}.
/// Throws InputError where it is no PLY, is cut off, has no x, y, z, or a coordinate that is not finite.
PointMap read_map_ply(const std::filesystem::path& path);

}  // namespace alidade
