// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <opencv2/core.hpp>

#include "app/result_directory.h"
#include "camera/camera.h"
#include "tracking/refinement.h"

namespace alidade {

/// One overlay picture kept for the report.
struct OverlaySample {
  int frame = 0;
  cv::Mat picture;
};

/// How a live camera was kept up with.
struct LiveTally {
  std::uint64_t dropped = 0;       ///< frames that the camera counted and that never came
  std::uint64_t discarded = 0;     ///< frames that came while the tracker was not ready for them
  std::vector<float> latencies_s;  ///< of every frame, from the middle of its exposure until its pose was told
};

/// The latency that a share (0 to 1) of the frames stays within, s; 0 where there is none.
double latency_quantile(const LiveTally& tally, double share);

/// All that a camera track leaves, before it is written.
struct TrackRecord {
  Camera camera;
  std::string source;  ///< FrameSource::describe()
  bool has_times = false;
  std::string scale;                 ///< where the unit of length comes from, in words
  std::vector<FrameReport> reports;  ///< one per image
  PointMap map;
  std::optional<RefinementSummary> refinement;
  std::optional<LiveTally> live;  ///< of a live camera
  std::vector<std::string> warnings;
  std::vector<OverlaySample> overlays;
  double tracking_s = 0;  ///< reading and tracking, without overlays and refinement
  bool interrupted = false;
};

/// Poses of the reports that have one, with covariances.
Trajectory trajectory_of(const std::vector<FrameReport>& reports);

/// How many frames are in a state.
int count(const std::vector<FrameReport>& reports, FrameState state);

/// The content of summary.json.
nlohmann::json summary_of(const TrackRecord& record);

/// The lines that end the command's output.
std::vector<std::string> table_lines(const TrackRecord& record);

/// Writes trajectory.tum, covariance.csv, frames.csv, camera.yaml, map.ply, colmap/, scene.png, plots.png and
/// report.html into the directory (the commit is the caller's). A machine that cannot draw gets all but scene.png, with
/// a warning in the record. Throws DeviceError where the file system refuses.
void write_track(TrackRecord& record, const ResultDirectory& directory, const std::vector<std::string>& arguments,
                 const std::string& options_yaml);

}  // namespace alidade
