// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "camera/receiver.h"

namespace alidade {

/// Reads the receivers of a file, in its order. Our YAML:
///
///     receivers:
///       - id: 0
///         name: north                        # may be left out
///         model: direction_finder            # or a camera's: pinhole, brown_conrady, fisheye, with its keys
///         sigma_rad: 0.001                   # of a camera sigma_px, 1 if it is left out
///         T_world_receiver: {translation_m: [0, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}
///         pose_covariance: [...]             # as of a camera's T_rig_camera; may be left out
///         clock: {offset_s: 0.2, rate: 1e-5, reference_s: 0, covariance: [1e-6, 0, 1e-12]}   # or: common
///
/// A direction finder of the paper's axes (FinderAxes::YUp) says `axes: y_up`. A file of cameras (read_camera_rig) is
/// taken as receivers 0, 1, ... of 1 px. Throws InputError with the line for what is none of these, a receiver without
/// a clock, two of one id, and what is impossible.
std::vector<Receiver> read_receivers(const std::filesystem::path& path);

/// Writes our YAML, which read_receivers gives back, rotations to the last digit but one. Throws DeviceError where the
/// file system refuses.
void write_receivers(const std::filesystem::path& path, std::span<const Receiver> receivers);

}  // namespace alidade
