// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "calib/bundle/board_bundle.h"

namespace alidade {

/// Where the board stands, T_camera_board, from one view of it: the better of the two poses that a plane allows
/// (Collins and Bartoli 2014, OpenCV's IPPE), then refined to the least weighted squares. Empty for fewer than six
/// corners, corners in one line, or where no pose puts the board in front of the camera.
std::optional<Eigen::Isometry3d> place_board(const Camera& camera, const BoardShape& shape, const BoardWarp& warp,
                                             std::span<const BoardCorner> corners);

}  // namespace alidade
