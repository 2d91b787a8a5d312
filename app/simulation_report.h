// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <opencv2/core.hpp>

#include "datasets/rendered_scene.h"
#include "view/report.h"

namespace alidade {

/// What a simulated sequence became, for those who write it down.
struct SimulationRecord {
  RenderedSceneOptions options;
  std::optional<Eigen::Isometry3d> T_world_marker;
  Trajectory truth;             ///< of the frames that were written
  std::vector<cv::Mat> frames;  ///< a few, for the report
  bool interrupted = false;
};

/// The content of summary.json.
nlohmann::json summary_of(const SimulationRecord& record);

/// The page: a few frames, the path from above and its height.
Report report_of(const SimulationRecord& record, const std::vector<std::string>& arguments, const std::string& options);

}  // namespace alidade
