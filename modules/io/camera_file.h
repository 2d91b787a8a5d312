// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"

namespace alidade {

/// Width and height of an image in px.
struct ImageSize {
  int width = 0, height = 0;
  bool operator==(const ImageSize&) const = default;
};

/// A camera and what its file calls it.
struct NamedCamera {
  std::string name;
  Camera camera;
};

/// The cameras of a file, in its order. The format is told from the content: our YAML (below), OpenCV's, ROS' and
/// Kalibr's YAML, OpenCV's XML, COLMAP's cameras.txt, mrcal's *.cameramodel, "fx 500 fy 500 cx 320 cy 240 k1 0.1"
/// (camera.txt), Strecha's *.camera, KITTI's calib.txt, or a bare 3×3 matrix. A file that says no image size takes
/// `size_of_images`.
///
///   camera:                     # or cameras: with a list of such
///     name: left                # may be left out
///     model: brown_conrady      # or pinhole, which has no distortion, or fisheye
///     resolution_px: [640, 480]
///     intrinsics_px: {fx: 500, fy: 500, cx: 319.5, cy: 239.5}
///     distortion: {k1: 0, k2: 0, p1: 0, p2: 0, k3: 0}
///     readout_s: 0.02           # of a rolling shutter, first row to last; may be left out
///
/// with, where they are known, the pose, covariances and clock that read_camera_rig (rig_file.h) gives.
/// COLMAP's pixel (0.5, 0.5), the centre of the top-left pixel, becomes our (0, 0).
/// Throws InputError, with the line where there is one, for a file that is none of these or is damaged, a key that is
/// not known, an impossible camera, and an image size that neither the file nor `size_of_images` says.
std::vector<NamedCamera> read_cameras(const std::filesystem::path& path,
                                      std::optional<ImageSize> size_of_images = std::nullopt);

/// The only camera of a file, as read_cameras; also one of several that are all the same (KITTI's).
/// Throws InputError where the file holds different ones.
Camera read_camera(const std::filesystem::path& path, std::optional<ImageSize> size_of_images = std::nullopt);

/// Writes our YAML, which read_camera gives back exactly. Throws DeviceError where the file system refuses.
void write_camera(const std::filesystem::path& path, const Camera& camera, const std::string& name = "camera");

}  // namespace alidade
