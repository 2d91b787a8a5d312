// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/board_placement.h"

#include <cmath>

#include <Eigen/SVD>
#include <opencv2/calib3d.hpp>

#include "geometry/rotation.h"

namespace alidade {
namespace {

struct PlanarPoints {
  std::vector<cv::Point3d> board;
  std::vector<cv::Point2d> plane;  // at focal length 1
};

// Corners whose rays do not go well forward have no place on a plane; a fisheye may see such.
PlanarPoints undistorted(const Camera& camera, const BoardShape& shape, std::span<const BoardCorner> corners) {
  PlanarPoints points;
  for (const BoardCorner& corner : corners) {
    const auto direction = unproject(camera, corner.pixel);
    if (!direction || direction->z() < 0.15) continue;
    const Eigen::Vector3d& p = shape.corners_m[static_cast<std::size_t>(corner.id)];
    points.board.emplace_back(p.x(), p.y(), p.z());
    points.plane.emplace_back(direction->x() / direction->z(), direction->y() / direction->z());
  }
  return points;
}

// Whether the points span a plane and not a line.
bool spans_plane(const std::vector<cv::Point3d>& points) {
  Eigen::Matrix2Xd xy(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) xy.col(static_cast<Eigen::Index>(i)) << points[i].x, points[i].y;
  xy.colwise() -= xy.rowwise().mean().eval();
  const auto spread = xy.jacobiSvd().singularValues();
  return spread[1] > 0.02 * spread[0];
}

Eigen::Isometry3d pose_from(const cv::Mat& rotation, const cv::Mat& translation) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3({rotation.at<double>(0), rotation.at<double>(1), rotation.at<double>(2)});
  T.translation() << translation.at<double>(0), translation.at<double>(1), translation.at<double>(2);
  return T;
}

}  // namespace

std::optional<Eigen::Isometry3d> place_board(const Camera& camera, const BoardShape& shape, const BoardWarp& warp,
                                             std::span<const BoardCorner> corners) {
  const PlanarPoints points = undistorted(camera, shape, corners);
  if (points.board.size() < 6 || !spans_plane(points.board)) return std::nullopt;
  std::vector<cv::Mat> rotations, translations;
  cv::solvePnPGeneric(points.board, points.plane, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations, translations,
                      false, cv::SOLVEPNP_IPPE);
  const BundleView view{0, 0, {corners.begin(), corners.end()}, std::vector<double>(corners.size(), 1.0)};
  std::optional<BundleSolution> best;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const Eigen::Isometry3d T_camera_board = pose_from(rotations[i], translations[i]);
    if (!T_camera_board.matrix().allFinite()) continue;
    BundleFreedom freedom;
    freedom.camera_poses = freedom.warp = false;
    auto placed = solve_bundle({{{camera, Eigen::Isometry3d::Identity()}}, {T_camera_board}, warp}, shape,
                               std::span(&view, 1), freedom, {30});
    if (!best || placed.cost < best->cost) best = std::move(placed);
  }
  if (!best) return std::nullopt;
  return best->bundle.T_rig_board.front();
}

}  // namespace alidade
