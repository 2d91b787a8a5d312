// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera_rig.h"

namespace alidade {

/// Formats of camera files that other programs read; read_camera_rig reads them all back.
enum class CameraFormat {
  Alidade,  ///< our YAML (rig_file.h)
  OpenCv,   ///< YAML: camera_matrix and distortion_coefficients, or a stereo pair M1 D1 M2 D2 R T
  Ros,      ///< camera_info YAML of one camera: plumb_bob, rational_polynomial or equidistant
  Kalibr,   ///< camchain YAML: pinhole with radtan, equidistant or none
  Colmap,   ///< cameras.txt: PINHOLE, OPENCV, FULL_OPENCV or OPENCV_FISHEYE
  Mrcal,    ///< .cameramodel of one camera: LENSMODEL_PINHOLE, _OPENCV4, _OPENCV5 or _OPENCV8
};

/// Its name on the command line: "kalibr".
const char* to_string(CameraFormat format);

/// Says why a rig cannot be written in this format at all ("mrcal has no fisheye of OpenCV's (camera 'left')"); empty
/// where it can.
std::optional<std::string> find_obstacle(CameraFormat format, const CameraRig& rig);

/// What the rig knows and the format has no place for: "covariances", "read-out times", ... Empty where nothing is
/// lost.
std::vector<std::string> list_losses(CameraFormat format, const CameraRig& rig);

/// The file's content. Intrinsics and poses are kept to the last digits. OpenCV's and Kalibr's poses are
/// relative to the first camera. Throws std::invalid_argument where find_obstacle says why not.
std::string format_cameras(CameraFormat format, const CameraRig& rig);

/// Writes format_cameras. Throws InputError naming `path` where there is an obstacle, DeviceError where the file system
/// refuses.
void write_cameras_as(const std::filesystem::path& path, CameraFormat format, const CameraRig& rig);

}  // namespace alidade
