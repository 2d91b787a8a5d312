// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include "camera/receiver.h"
#include "datasets/target_scene.h"
#include "uav/target_state.h"

namespace alidade {

/// The bearings of a simulated scene, and those of one target.
inline std::vector<Bearing> bearings_of(const TargetScene& scene) {
  return bearings_of(scene.receivers, scene.readings);
}

inline std::vector<Bearing> bearings_of_target(const TargetScene& scene, int target) {
  std::vector<Bearing> of_target;
  std::ranges::copy_if(bearings_of(scene), std::back_inserter(of_target),
                       [&](const Bearing& bearing) { return bearing.target == target; });
  return of_target;
}

inline TargetState true_state(const TargetPath& path, Timestamp time) {
  TargetState state;
  state.time = time;
  state.p_world = position_at(path, time);
  state.v_world = velocity_at(path, time);
  state.a_world = path.a_world;
  return state;
}

}  // namespace alidade
