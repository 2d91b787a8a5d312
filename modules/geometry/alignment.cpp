// SPDX-License-Identifier: Apache-2.0
#include "geometry/alignment.h"

#include <stdexcept>

#include <Eigen/SVD>

namespace alidade {
namespace {

using Points = Eigen::Matrix3Xd;

Points as_matrix(std::span<const Eigen::Vector3d> points) {
  Points matrix(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) matrix.col(static_cast<Eigen::Index>(i)) = points[i];
  return matrix;
}

// Two of the three directions of the cross-covariance must be present: on one line the rotation about it is free.
bool determines_rotation(const Points& source, const Points& target) {
  const Points a = source.colwise() - source.rowwise().mean();
  const Points b = target.colwise() - target.rowwise().mean();
  const Eigen::Vector3d s = Eigen::JacobiSVD<Eigen::Matrix3d>(b * a.transpose()).singularValues();
  return s(1) > 1e-12 * s(0);
}

}  // namespace

std::optional<Similarity> align_points(std::span<const Eigen::Vector3d> source, std::span<const Eigen::Vector3d> target,
                                       AlignmentKind kind) {
  if (source.size() != target.size()) throw std::invalid_argument("align_points: source and target differ in length");
  if (kind == AlignmentKind::None) return Similarity{};
  if (source.size() < 3) return std::nullopt;
  const Points a = as_matrix(source);
  const Points b = as_matrix(target);
  if (!determines_rotation(a, b)) return std::nullopt;
  const Eigen::Matrix4d M = Eigen::umeyama(a, b, kind == AlignmentKind::Similarity);
  Similarity result;
  result.scale = kind == AlignmentKind::Similarity ? M.topLeftCorner<3, 3>().col(0).norm() : 1.0;
  result.T_target_source.linear() = M.topLeftCorner<3, 3>() / result.scale;
  result.T_target_source.translation() = M.topRightCorner<3, 1>();
  return result;
}

Eigen::Vector3d operator*(const Similarity& similarity, const Eigen::Vector3d& p_source) {
  return similarity.T_target_source * (similarity.scale * p_source);
}

StampedPose transform(const Similarity& similarity, const StampedPose& pose) {
  StampedPose moved = pose;
  moved.T_world_camera.translation() = similarity * Eigen::Vector3d(pose.T_world_camera.translation());
  moved.T_world_camera.linear() = similarity.T_target_source.linear() * pose.T_world_camera.linear();
  if (moved.covariance) {
    moved.covariance->topRows<3>() *= similarity.scale;
    moved.covariance->leftCols<3>() *= similarity.scale;
  }
  return moved;
}

Trajectory transform(const Similarity& similarity, const Trajectory& trajectory) {
  Trajectory moved;
  moved.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory) moved.push_back(transform(similarity, pose));
  return moved;
}

}  // namespace alidade
