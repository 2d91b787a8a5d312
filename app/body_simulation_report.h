// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <opencv2/core/mat.hpp>

#include "datasets/body_scene.h"
#include "geometry/trajectory.h"
#include "view/report.h"

namespace alidade {

/// What simulated readings became, for those who write it down: a few numbers however long the sequence.
struct BodySimulationRecord {
  BodySceneOptions options;
  std::vector<std::string> truth_files;      ///< one per body
  std::vector<std::string> body_names;       ///< likewise
  std::vector<Trajectory> truth;             ///< likewise: every so many frames
  std::vector<double> readings_per_frame;    ///< at the same frames
  std::int64_t readings = 0, wrong_ids = 0;  ///< of all frames
  int frames = 0;                            ///< written
  bool interrupted = false;
  cv::Mat line_image;  ///< the first rows of the first detector, where images were drawn

  void add(const BodySceneFrame& frame, const std::vector<Eigen::Isometry3d>& T_world_body);
};

/// The content of summary.json.
nlohmann::json summary_of(const BodySimulationRecord& record);

/// The page: the paths from above, their heights, and how much is seen.
Report report_of(const BodySimulationRecord& record, const std::vector<std::string>& arguments,
                 const std::string& options);

}  // namespace alidade
