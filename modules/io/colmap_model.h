// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "camera/camera.h"
#include "geometry/point_map.h"

namespace alidade {

/// A map and the camera of its keyframes.
struct ColmapModel {
  Camera camera;
  PointMap map;
};

/// Writes cameras.txt, images.txt and points3D.txt, COLMAP's text model, into an existing folder: keyframe i has
/// IMAGE_ID i + 1, point i POINT3D_ID i + 1; pixels count from the image's corner there (ours + ½). Covariances,
/// descriptors and times have no place in it. Throws DeviceError where the file system refuses,
/// std::invalid_argument where a sighting names a point that is not there.
void write_colmap_model(const std::filesystem::path& folder, const Camera& camera, const PointMap& map);

/// Reads such a model, of one camera. Keyframes and points come in order of their IDs; Keyframe::frame is IMAGE_ID − 1
/// and its time that many seconds. Throws InputError with path and line.
ColmapModel read_colmap_model(const std::filesystem::path& folder);

}  // namespace alidade
