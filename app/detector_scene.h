// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera/detector_rig.h"
#include "view/scene.h"

namespace alidade {

/// How detectors are drawn.
struct DetectorLook {
  double size_m = 0.1;  ///< of the pyramids
  Rgb colour = palette::kInk;
  bool is_labelled = true;  ///< with the names of the stations, where they are not too many
};

/// Adds pyramids along the detectors' lines of sight, and names above the stations.
void add_detectors(const std::vector<LineDetector>& detectors, const DetectorLook& look, Scene& scene);

/// Adds ellipsoids of the positions of those stations that have a covariance, enlarged so far that the largest is not
/// larger than `most_m`, with a legend that tells how much.
void add_station_covariances(const DetectorRig& rig, double most_m, Scene& scene);

/// The largest of 1, 3, 10, 30, ... times `sigma_m` that is not more than `most_m`; 1 where that is, or sigma is no
/// positive number.
double enlargement(double sigma_m, double most_m);

}  // namespace alidade
