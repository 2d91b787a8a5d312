// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "camera/camera_rig.h"
#include "io/camera_file.h"

namespace alidade {

/// The cameras of a file with all that it says of them, in its order. The formats are those of read_cameras; in our
/// YAML a camera may also have (all may be left out):
///
///     T_rig_camera: {translation_m: [0.12, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}   # else the identity
///     pose_covariance: [...]                 # of T_rig_camera's right perturbation, 21 values: upper triangle by rows
///     intrinsics_covariance:
///       parameters: [fx, fy, cx, cy, k1]     # those that were free; the others' rows and columns are 0
///       covariance: [...]                    # upper triangle by rows in this order
///     clock_offset_s: 0.0042                 # added to the camera's times it gives the rig's
///
/// From OpenCV's stereo files (M1 D1 M2 D2 with R T) and Kalibr's camchains the rig's frame is the first camera's; from
/// mrcal's it is the reference of its extrinsics. Lengths are taken as metres. Throws as read_cameras, and InputError
/// with the line for what is no pose or no covariance, and two cameras of one name.
CameraRig read_camera_rig(const std::filesystem::path& path, std::optional<ImageSize> size_of_images = std::nullopt);

/// Our YAML: `camera:` for one camera, `cameras:` for several. read_camera_rig gives all back exactly, rotations to the
/// last digit but one. Throws std::invalid_argument for a rig without cameras, with two of one name, or with a
/// covariance of another size than its camera's intrinsics.
std::string format_camera_rig(const CameraRig& rig);

/// Writes format_camera_rig(rig). Throws DeviceError where the file system refuses.
void write_camera_rig(const std::filesystem::path& path, const CameraRig& rig);

}  // namespace alidade
