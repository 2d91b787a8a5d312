// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"
#include "features/patch_alignment.h"
#include "tracking/live_map.h"

namespace alidade {

struct SightingAlignmentOptions {
  PatchAlignmentOptions patch;
  double sigma_share = 0.3;  ///< what alignment leaves of a sighting's sigma_px
};

struct SightingAlignment {
  LiveMap live;
  int aligned = 0;  ///< sightings that now agree with another one of their point; the rest stand as they were found
};

/// Aligns, for every point, the texture about its sightings with that about the one in their middle, which stays: the
/// sightings of one point then show the same spot of the scene to a few hundredths of a pixel, where SIFT places each
/// for itself. Poses and points must fit to a few pixels, and the keyframes' images must be there.
SightingAlignment align_sightings(const Camera& camera, LiveMap live, const SightingAlignmentOptions& options = {});

}  // namespace alidade
