// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <opencv2/core.hpp>

#include "camera/camera.h"
#include "view/report.h"

namespace alidade {

/// What became of undistorted images, for those who write it down.
struct UndistortionRecord {
  std::string source;  ///< FrameSource::describe
  Camera camera, pinhole;
  std::size_t frames = 0;
  cv::Mat before, after;  ///< the first frame
  std::vector<std::string> warnings;
  bool interrupted = false;
};

/// The content of summary.json.
nlohmann::json summary_of(const UndistortionRecord& record);

/// The page: the first frame before and after, and the pinhole camera.
Report report_of(const UndistortionRecord& record, const std::vector<std::string>& arguments,
                 const std::string& options);

}  // namespace alidade
