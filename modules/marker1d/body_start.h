// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "marker1d/body_readings.h"

namespace alidade {

struct BodyStartOptions {
  double gate_chi2 = 20.0;      ///< as in BodyUpdateOptions
  double most_speed_m_s = 1.0;  ///< of the body while readings of different times are taken for one moment's
  double least_share = 0.5;     ///< of the readings that must fit
};

/// A pose that may be the body's.
struct BodyCandidate {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of the right perturbation, m and rad
  double chi2 = 0.0;
  int inlier_count = 0;
};

/// The poses that readings near one moment leave possible, most probable first: none where they do not determine it (or
/// contradict each other), one where it is certain, several where it is ambiguous. Nothing is known beforehand.
std::vector<BodyCandidate> start_body(const DetectorArray& detectors, const RigidBody& body,
                                      std::span<const LineReading> readings, Timestamp time,
                                      const BodyStartOptions& options = {});

}  // namespace alidade
