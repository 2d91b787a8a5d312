// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "marker1d/body_readings.h"
#include "marker1d/body_update.h"

namespace alidade {

struct BodyStartOptions {
  BodyUpdateOptions update;
  double speed_m_s = 2.0;  ///< standard deviations of a motion of which nothing is known
  double rate_rad_s = 6.0;
  double acceleration_m_s2 = 5.0;  ///< while readings for a start are gathered
  double acceleration_rad_s2 = 15.0;
  double least_share = 0.4;  ///< of the readings that must fit, and ten, where not all do
  /// Odds, as a natural logarithm, against a pose that is left out beside a better one.
  double least_log_odds = 18.0;
};

/// The poses that are local optima of readings taken for one moment's, by their planes alone: none where they do not
/// determine the pose.
std::vector<Eigen::Isometry3d> poses_by_planes(const DetectorArray& detectors, const RigidBody& body,
                                               std::span<const LineReading> readings);

/// A state that may be the body's, from readings alone.
struct BodyCandidate {
  MotionState state;
  double log_evidence = 0.0;
  std::vector<bool> is_inlier;  ///< one per reading
  int inlier_count = 0;
};

/// The states that readings near one moment leave possible, most probable first: none where they do not determine the
/// pose or contradict each other, one where it is certain, several where it is ambiguous. Nothing is known beforehand
/// but that the body does not move faster than the options say.
std::vector<BodyCandidate> start_body(const DetectorArray& detectors, const RigidBody& body,
                                      std::span<const LineReading> readings, Timestamp time, double variance_factor,
                                      const BodyStartOptions& options = {});

}  // namespace alidade
