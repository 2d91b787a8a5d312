// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "datasets/sky_scene.h"
#include "datasets/target_scene.h"
#include "io/target_file.h"
#include "view/report.h"
#include "view/scene.h"

namespace alidade {

/// The true positions and velocities of a scene's targets while they are there, `rate_hz` per second, in order of time.
std::vector<TargetRow> truth_of(const TargetScene& scene, double rate_hz);

std::vector<TargetRow> truth_of(std::span<const TargetPath> paths, double rate_hz, double duration_s);

/// The receivers, as pyramids, and the true paths; up is the world's z.
Scene picture_of(std::span<const Receiver> receivers, std::span<const TargetRow> truth);

/// The content of summary.json.
nlohmann::json summary_of(const TargetSceneOptions& options, const TargetScene& scene);
nlohmann::json summary_of(const SkySceneOptions& options, const SkyScene& scene,
                          const std::vector<std::string>& videos);

/// The page: the scene drawn, paths from above, when which receiver saw what; of videos a frame.
Report report_of(const TargetSceneOptions& options, const TargetScene& scene, std::span<const TargetRow> truth,
                 const std::vector<std::string>& arguments);
Report report_of(const SkyScene& scene, std::span<const TargetRow> truth, const std::vector<std::string>& videos,
                 const std::vector<std::string>& arguments);

}  // namespace alidade
