// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "camera/line_detector.h"
#include "geometry/pose.h"

namespace alidade {

/// Line detectors, and how well it is known where their stations stand.
struct DetectorRig {
  std::vector<LineDetector> detectors;
  /// Of T_world_station by the station's name: of the right perturbation xi = (translation, rotation), m² and rad²; a
  /// station that is not in it is taken as exact.
  std::map<std::string, Matrix6d> station_covariance;
};

}  // namespace alidade
