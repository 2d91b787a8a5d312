// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "datasets/rendered_sky.h"

namespace alidade {

/// Options of a scene of standing cameras about a piece of sky in which targets fly to and fro.
struct SkySceneOptions {
  int receivers = 3;
  double range_m = 110.0;          ///< of the cameras from the middle of the targets' space, on the ground
  double arc_rad = 2.1;            ///< the cameras stand evenly on an arc of this angle about it
  int width = 1280, height = 720;  ///< px
  double focal_px = 900.0;
  double fps_hz = 30.0;           ///< of the first receiver; each further one is 1 % slower
  double readout_s = 0.01;        ///< rolling shutter
  double clock_offset_s = 0.013;  ///< of receiver k's clock: k times this
  double duration_s = 10.0;
  std::vector<DotLook> dots{{4.0, 10.0, true}, {3.0, 8.0, false}, {5.0, 6.0, true}};  ///< one per target
  double least_speed_m_s = 6.0, greatest_speed_m_s = 14.0;
  double least_speed_px_s = 12.0;  ///< in every camera's image: what hangs there is no moving object
  SkyLook look;
  unsigned seed = 1;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const SkySceneOptions& options);

/// Cameras 2 m above the ground that look up a little so that the skyline is in the picture, and targets on curved
/// paths (constant acceleration) that stay in the view of all cameras; where no such path is found they are slower, and
/// may be. The same options give the same scene.
SkyScene make_sky_scene(const SkySceneOptions& options = {});

}  // namespace alidade
