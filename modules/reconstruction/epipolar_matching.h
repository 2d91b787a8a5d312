// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "camera/camera.h"
#include "features/matching.h"
#include "geometry/pose.h"

namespace alidade {

/// Some of the features of a posed image.
struct PosedFeatures {
  const Features& features;
  std::span<const int> subset;  ///< indices of those that take part
  Eigen::Isometry3d T_world_camera;
};

struct EpipolarOptions {
  double band_px = 2.0;          ///< half width of the band about the epipolar line
  double ratio = 0.8;            ///< of the descriptor distances, nearest to second nearest within the band
  double most_distance = 210.0;  ///< of descriptors; a band holds too few to tell a wrong nearest one by the ratio
};

/// Matches the features of two posed images of one camera, each looked for only about its epipolar line in the other:
/// the nearest descriptor in the band, distinctly nearer than the second, and mutual. Empty where the centres coincide.
std::vector<Match> match_along_epipolar_lines(const Camera& camera, const PosedFeatures& a, const PosedFeatures& b,
                                              const EpipolarOptions& options = {});

}  // namespace alidade
