// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/time.h"

namespace alidade {

/// Something with a name at a place, m.
struct IdentifiedPosition {
  int id = 0;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  std::optional<Eigen::Matrix3d> covariance{};  ///< of p_world, m²
};

/// What is true and what is answered at one moment; no id twice in either.
struct TargetMoment {
  Timestamp time{};
  std::vector<IdentifiedPosition> truth, estimates;
};

/// The estimate that belongs to each true target (its place in `estimates`, empty for none): the pairs within
/// `radius_m` with the least sum of squared distances.
std::vector<std::optional<std::size_t>> pair_by_place(const TargetMoment& moment, double radius_m);

/// What became of one true target.
struct TargetHistory {
  int id = 0;
  int moments = 0, paired = 0;    ///< moments at which it was there, and had an estimate
  int switches = 0;               ///< times that its estimate had another id than its estimate before
  std::optional<double> found_s;  ///< from its first moment to its first estimate; empty: never
  /// From its last moment to the last one at which its last estimate's id was answered still, of no other target; 0:
  /// given up at once. Empty where there is no moment after its last, or it had no estimate.
  std::optional<double> outlived_s;
};

/// How well ids keep to targets, over moments in order of time.
struct TrackIdentity {
  std::vector<TargetHistory> targets;  ///< by first appearance
  int switches = 0;                    ///< of all targets
  double purity = 1.0;  ///< share of the paired estimates that belong to the target that their id mostly belongs to
  double completeness = 1.0;  ///< share of the true targets' moments that had an estimate
  int false_ids = 0;          ///< ids that never belonged to a target
};

/// Throws std::invalid_argument for moments out of order and a radius that is not above 0.
/// Source: Bernardin, Stiefelhagen, Evaluating multiple object tracking performance, 2008 (switches).
TrackIdentity track_identity(std::span<const TargetMoment> moments, double radius_m);

}  // namespace alidade
