// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/trajectory.h"

namespace alidade {

/// A similarity: p_target = scale * T_target_source.linear() * p_source + T_target_source.translation().
struct Similarity {
  double scale = 1.0;
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
};

enum class AlignmentKind { None, Rigid, Similarity };

/// The least-squares rigid or similarity transform from paired points; identity for AlignmentKind::None. Empty where
/// it is not determined: fewer than three pairs, or all points on one line (one point for a similarity's scale).
/// Throws std::invalid_argument where the two spans differ in length. Source: Umeyama 1991.
std::optional<Similarity> align_points(std::span<const Eigen::Vector3d> source, std::span<const Eigen::Vector3d> target,
                                       AlignmentKind kind);

Eigen::Vector3d operator*(const Similarity& similarity, const Eigen::Vector3d& p_source);

/// A pose moved into the target frame: its centre is mapped, its rotation turned, its covariance scaled.
StampedPose transform(const Similarity& similarity, const StampedPose& pose);

Trajectory transform(const Similarity& similarity, const Trajectory& trajectory);

}  // namespace alidade
