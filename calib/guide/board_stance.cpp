// SPDX-License-Identifier: Apache-2.0
#include "calib/guide/board_stance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <variant>

namespace alidade {
namespace {

struct BoardSize {
  Eigen::Vector3d centre_m;
  double width_m = 0, height_m = 0;
};

BoardSize size_of(const BoardShape& shape) {
  Eigen::Vector3d least = shape.corners_m.front(), most = least;
  for (const Eigen::Vector3d& p : shape.corners_m) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  return {0.5 * (least + most), most.x() - least.x(), most.y() - least.y()};
}

// A frame whose xy-plane shows the board undistorted: the camera's; of a fisheye, one that looks at the board.
Eigen::Matrix3d plane_frame(const Camera& camera, const Eigen::Vector3d& d_camera) {
  if (!std::holds_alternative<Fisheye>(camera.distortion)) return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), d_camera).toRotationMatrix();
}

struct Fit {
  double share_m = 0;  // image_share times depth
  bool is_turned = false;
};

Fit fit_into_image(const Camera& camera, const BoardSize& size) {
  const double x = camera.fx / camera.width, y = camera.fy / camera.height;
  const double upright = std::max(size.width_m * x, size.height_m * y);
  const double turned = std::max(size.height_m * x, size.width_m * y);
  return {std::min(upright, turned), turned < upright};
}

Eigen::Matrix3d rotation_of(const BoardStance& stance) {
  const auto about = [&](const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(stance.tilt_rad, axis).toRotationMatrix();
  };
  switch (stance.tilt) {
    case BoardTilt::Facing:
      return Eigen::Matrix3d::Identity();
    case BoardTilt::LeftNearer:
      return about(-Eigen::Vector3d::UnitY());
    case BoardTilt::RightNearer:
      return about(Eigen::Vector3d::UnitY());
    case BoardTilt::TopNearer:
      return about(Eigen::Vector3d::UnitX());
    case BoardTilt::BottomNearer:
      return about(-Eigen::Vector3d::UnitX());
  }
  return Eigen::Matrix3d::Identity();
}

// Of a board whose normal (away from the camera) is `n`: it leans to where its normal points.
BoardTilt direction_of(const Eigen::Vector3d& n) {
  if (std::abs(n.x()) >= std::abs(n.y())) return n.x() > 0 ? BoardTilt::RightNearer : BoardTilt::LeftNearer;
  return n.y() > 0 ? BoardTilt::BottomNearer : BoardTilt::TopNearer;
}

}  // namespace

std::string_view name_of(BoardTilt tilt) {
  switch (tilt) {
    case BoardTilt::Facing:
      return "facing";
    case BoardTilt::LeftNearer:
      return "left nearer";
    case BoardTilt::RightNearer:
      return "right nearer";
    case BoardTilt::TopNearer:
      return "top nearer";
    case BoardTilt::BottomNearer:
      return "bottom nearer";
  }
  return "";
}

std::optional<BoardStance> stance_of(const Camera& camera, const BoardShape& shape,
                                     const Eigen::Isometry3d& T_camera_board, double least_tilt_rad) {
  const BoardSize size = size_of(shape);
  const Eigen::Vector3d p_camera = T_camera_board * size.centre_m;
  const auto seen = project(camera, p_camera);
  if (!seen) return std::nullopt;
  const Eigen::Matrix3d R_camera_plane = plane_frame(camera, p_camera.normalized());
  const Eigen::Vector3d n_plane = R_camera_plane.transpose() * T_camera_board.linear().col(2);
  BoardStance stance;
  stance.centre_px = seen->pixel;
  stance.tilt_rad = std::acos(std::clamp(n_plane.z(), -1.0, 1.0));
  if (stance.tilt_rad >= least_tilt_rad) stance.tilt = direction_of(n_plane);
  stance.image_share = fit_into_image(camera, size).share_m / (R_camera_plane.transpose() * p_camera).z();
  return stance;
}

std::optional<Eigen::Isometry3d> pose_with(const Camera& camera, const BoardShape& shape, const BoardStance& stance) {
  if (stance.image_share <= 0) throw std::invalid_argument("the share of the image must be > 0");
  const auto d_camera = unproject(camera, stance.centre_px);
  if (!d_camera) return std::nullopt;
  const BoardSize size = size_of(shape);
  const Fit fit = fit_into_image(camera, size);
  const Eigen::Matrix3d R_camera_plane = plane_frame(camera, *d_camera);
  const Eigen::Vector3d d_plane = R_camera_plane.transpose() * *d_camera;
  const Eigen::Vector3d p_camera = *d_camera * (fit.share_m / stance.image_share / d_plane.z());
  Eigen::Isometry3d T_camera_board(R_camera_plane * rotation_of(stance));
  if (fit.is_turned) T_camera_board.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  T_camera_board.translation() = p_camera - T_camera_board.linear() * size.centre_m;
  return T_camera_board;
}

}  // namespace alidade
