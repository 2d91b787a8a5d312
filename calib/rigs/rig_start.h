// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "calib/bundle/board_bundle.h"

namespace alidade {

/// Where a board stood before one camera at one moment.
struct PlacedBoard {
  int frame = 0;
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  int corners = 0;
};

/// Cameras that no chain of common views ties to the first one.
struct Untied {
  std::vector<int> cameras;
};

/// Poses of cameras in the frame of the first, T_rig_camera, from boards that they saw at the same moments: of each
/// pair the pose that most of its moments agree with, and from pair to pair along the chain with the most moments.
std::variant<std::vector<Eigen::Isometry3d>, Untied> chain_cameras(
    std::span<const std::vector<PlacedBoard>> boards_by_camera);

/// T_rig_board of every frame 0 .. frames-1, from the camera that saw most corners; frames that none saw: identity.
std::vector<Eigen::Isometry3d> place_frames(std::span<const std::vector<PlacedBoard>> boards_by_camera,
                                            std::span<const Eigen::Isometry3d> T_rig_camera, int frames);

}  // namespace alidade
