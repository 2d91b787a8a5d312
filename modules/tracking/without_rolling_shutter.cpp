// SPDX-License-Identifier: Apache-2.0
#include "tracking/without_rolling_shutter.h"

#include "camera/rolling_shutter.h"

namespace alidade {

std::vector<PointObservation> without_rolling_shutter(const Camera& camera, const MotionState& state,
                                                      std::vector<PointObservation> observations) {
  const Eigen::Isometry3d T_camera_world = state.T_world_body.inverse();
  for (PointObservation& o : observations) {
    const double depth_m = (T_camera_world * o.p_world).z();
    if (depth_m > 0) o.pixel = at_middle_row(camera, o.pixel, twist_of(state), depth_m);
  }
  return observations;
}

}  // namespace alidade
