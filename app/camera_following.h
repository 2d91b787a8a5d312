// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/camera_source.h"
#include "app/frame_overlay.h"
#include "app/live_output.h"
#include "app/track_record.h"
#include "app/world_scale.h"
#include "core/errors.h"
#include "tracking/camera_tracker.h"

namespace alidade {

/// How a camera's frames are followed, from its first to its last.
struct FollowOptions {
  std::string source;              ///< as the user named it, for messages
  std::optional<int> most_frames;  ///< empty: until the source ends or the user stops it
  std::optional<double> most_s;    ///< by the host's clock; empty: the same
  bool looks_for_markers = false;  ///< in keyframes
  OverlayMovie* movie = nullptr;   ///< every frame is drawn into it
  LiveOutput* live = nullptr;      ///< every frame's pose is sent there at once
};

/// What came of it.
struct FollowedCamera {
  std::vector<FrameReport> reports;  ///< one per frame
  std::vector<FrameMarkers> markers;
  std::int64_t tracked_at_once = 0;  ///< frames whose pose was told when they came
  double tracking_s = 0;             ///< waiting for frames and tracking
  bool interrupted = false;
  std::optional<LiveTally> tally;    ///< of a live camera
  std::optional<DeviceError> fault;  ///< what ended the source
};

/// Follows the camera through the frames of `source`. Frames of a live camera are answered at once (LiveTracker);
/// other sources wait until the tracker has done all its work, and give the same result every time.
FollowedCamera follow_camera(const RunContext& context, CameraSource& source, CameraTracker& tracker,
                             const FollowOptions& options);

}  // namespace alidade
