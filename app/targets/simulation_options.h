// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/options_yaml.h"
#include "datasets/sky_scene.h"
#include "datasets/target_scene.h"

namespace alidade {

/// What `simulate targets` can be asked for.
struct TargetSimulationOptions {
  TargetSceneOptions scene;
  std::string delays_s = "0,0.1,0.2";  ///< TargetSceneOptions::delays_s as text
  double truth_rate_hz = 10.0;         ///< rows of the true paths per second and target
  bool has_videos = false;             ///< what cameras film of them instead of bearings
  SkySceneOptions sky;
  double dot_size_px = 4.0, dot_snr = 10.0;  ///< of all targets in the videos
};

/// Binds them to flags and keys of --config. `options` must outlive `fields`.
void bind(OptionFields& fields, TargetSimulationOptions& options);

/// The scene asked for: of bearings, or of videos. Throws std::invalid_argument naming what is impossible.
TargetSceneOptions scene_of(const TargetSimulationOptions& options);
SkySceneOptions sky_of(const TargetSimulationOptions& options);

}  // namespace alidade
