// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <opencv2/core/mat.hpp>

#include "capture/recording/session_file.h"
#include "view/report.h"

namespace alidade {

/// A closed recording, for those who tell of it.
struct RecordedCamera {
  std::string name;    ///< empty for the only camera
  std::string folder;  ///< below the result directory; "." for the only camera
  RecordingSession session;
  std::vector<double> times_s;  ///< of the frames, from the first of all cameras
  cv::Mat first;                ///< the first frame that can be shown
};

struct RecordRecord {
  std::vector<RecordedCamera> cameras;
  std::vector<std::string> warnings;
  bool interrupted = false;
};

/// Reads the rows, and the first image, of closed recordings. Throws InputError.
std::vector<RecordedCamera> read_recorded(const std::filesystem::path& folder);

/// Mean frame rate over a recording, Hz; 0 for less than two frames.
double mean_rate_hz(const RecordedCamera& camera);

/// A line for each camera.
std::vector<std::string> table_lines(const RecordRecord& record);

/// The content of summary.json.
nlohmann::json summary_of(const RecordRecord& record);

/// The page: what came and what was lost, the first images, the intervals between frames.
Report report_of(const RecordRecord& record, const std::vector<std::string>& arguments, const std::string& options);

}  // namespace alidade
