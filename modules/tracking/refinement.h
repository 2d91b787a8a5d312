// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/progress.h"
#include "tracking/camera_tracker_options.h"
#include "tracking/frame.h"
#include "tracking/live_map.h"

namespace alidade {

/// Bundle adjustment of the last `window` keyframes, those before them that share most points with the newest (at most
/// `most_fixed`) holding them; outlying sightings are removed, covariances filled in. The first `anchored` keyframes
/// never move.
LiveMap refine_locally(const Camera& camera, LiveMap live, int anchored, int window, int most_fixed);

/// What global refinement has done, for the report.
struct RefinementSummary {
  double rms_px_before = 0;
  double rms_px_after = 0;
  int sightings = 0;
  int sightings_added = 0;
  int sightings_removed = 0;
  int sightings_aligned = 0;  ///< by their texture
  int iterations = 0;
  double seconds = 0;
  double focal_factor = 1.0;  ///< the factor on the focal length that would fit best
  double focal_factor_sigma = 0.0;
};

/// One line for the user where the images speak clearly against the camera's focal length (more than 4 % and five
/// standard deviations), with the one that fits; empty where they do not.
std::optional<std::string> doubt_focal_length(const Camera& camera, const RefinementSummary& summary);

struct RefinedTrack {
  LiveMap live;
  std::vector<FrameReport> reports;
  RefinementSummary summary;
};

/// Bundle adjustment of all keyframes and points after a recording has been tracked: sightings that were missed are
/// added, outlying ones removed, all aligned by their texture, covariances filled in; then every other frame's pose is
/// estimated again in the refined map from the sightings that its report holds. `anchored` keyframes stay fixed. A
/// requested stop ends it after the step at hand, with what has been gained so far.
RefinedTrack refine_globally(const Camera& camera, LiveMap live, std::vector<FrameReport> reports,
                             const CameraTrackerOptions& options, int anchored, const ProgressSink& progress = {},
                             const std::stop_token& stop = {});

/// Estimates the poses of the frames that are no keyframes again, in order, in a map that has changed.
std::vector<FrameReport> relocate_frames(const Camera& camera, const PointMap& map, std::vector<FrameReport> reports,
                                         const CameraTrackerOptions& options);

}  // namespace alidade
