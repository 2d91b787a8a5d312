// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <Eigen/Core>

#include "camera/camera.h"
#include "geometry/pose.h"

namespace alidade {

/// The pose with rotation R (row-major 3×3 of the file) and translation t. The rotation is brought back to SO(3) from
/// the rounding of its digits; throws InputError where it is farther than 1e-2 from one.
Eigen::Isometry3d pose_from(const std::filesystem::path& path, int line, const Eigen::Matrix3d& R,
                            const Eigen::Vector3d& t);

/// The camera file `name` in `folder` or the folder above it, for images of the size of `image`; empty where there is
/// none.
std::optional<Camera> find_camera(const std::filesystem::path& folder, const char* name,
                                  const std::filesystem::path& image);

}  // namespace alidade
