// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "calib/bundle/board_bundle.h"

namespace alidade {

/// Which side of a board, as the image shows it, is nearer to the camera than the opposite one.
enum class BoardTilt { Facing, LeftNearer, RightNearer, TopNearer, BottomNearer };

inline constexpr std::array<BoardTilt, 4> kTilts{BoardTilt::LeftNearer, BoardTilt::RightNearer, BoardTilt::TopNearer,
                                                 BoardTilt::BottomNearer};

/// "facing", "left nearer", ...
std::string_view name_of(BoardTilt tilt);

/// How a board stands before a camera, in terms that a person can follow. Tilt and size are those against the image
/// plane; of a fisheye, against the plane across the line of sight to the board's middle.
struct BoardStance {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< where its middle is seen
  BoardTilt tilt = BoardTilt::Facing;
  double tilt_rad = 0;     ///< between the board's normal and that of the plane
  double image_share = 0;  ///< 1: facing the camera (turned upright or not), its corners would just fit into the image
};

/// The stance of a board at T_camera_board; Facing below `least_tilt_rad`. Empty where its middle has no pixel.
std::optional<BoardStance> stance_of(const Camera& camera, const BoardShape& shape,
                                     const Eigen::Isometry3d& T_camera_board, double least_tilt_rad);

/// T_camera_board of an upright board with this stance. Empty where the lens has no direction for its middle. Throws
/// std::invalid_argument for a share that is not positive.
std::optional<Eigen::Isometry3d> pose_with(const Camera& camera, const BoardShape& shape, const BoardStance& stance);

}  // namespace alidade
