// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/uav/flown_scene.h"
#include "uav/window/window_scans.h"

namespace alidade {

/// A simulated scene as a prepared window, all its bearings free.
struct SeenWindow {
  TargetScene scene;
  std::vector<Bearing> bearings;
  BearingWindow window;
  std::vector<char> is_free;

  std::vector<std::size_t> of_target(int target) const {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < bearings.size(); ++i) {
      if (bearings[i].target == target) places.push_back(i);
    }
    return places;
  }
};

inline SeenWindow see(const TargetSceneOptions& options) {
  SeenWindow seen{make_target_scene(options), {}, {}, {}};
  seen.bearings = bearings_of(seen.scene);
  seen.window = prepare_window(seen.bearings, {});
  seen.is_free.assign(seen.bearings.size(), 1);
  return seen;
}

inline SeenWindow see(int targets, unsigned seed, double detection_probability = 1.0) {
  TargetSceneOptions options;
  options.targets = targets;
  options.detection_probability = detection_probability;
  options.seed = seed;
  return see(options);
}

}  // namespace alidade
