// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "features/flow.h"
#include "tracking/camera_tracker_options.h"
#include "tracking/frame.h"
#include "tracking/live_motion.h"
#include "tracking/map_search.h"

namespace alidade {

/// A frame in which map points are known to be, and how the camera moves there: what a tracker that takes its time
/// knows of the last image that it took.
struct TrackAnchor {
  Timestamp time{};
  FlowImage image;
  LiveMotion motion;
  std::vector<MapPoint> points;    ///< of the map: those in the image
  std::vector<FoundPoint> tracks;  ///< where they were found; `point` counts in the map
  double sigma_px = 1.0;
};

/// Follows a camera by optical flow alone, from anchors that come late: in a few milliseconds per frame, however long
/// it takes to find features, to let a map grow and to adjust it. A new anchor takes back what flow has drifted since
/// the one before; flow leads from the anchor's image straight to the next frame, or, where the camera was lost,
/// through those between, a few at every step.
class AnchorFollower {
 public:
  AnchorFollower(Camera camera, CameraTrackerOptions options);

  /// What is known of a frame already taken, or of one before it: used from the next frame on.
  void put(TrackAnchor anchor);

  /// The next image, in order of time. Waits (FrameState) until there was an anchor; `reason`: why there is none yet.
  FrameReport step(const ImageFrame& frame, const std::string& reason);

  /// The last frame, as an anchor for the next; empty where the camera was not measured in it.
  std::optional<TrackAnchor> last() const { return missed_ == 0 ? last_ : std::nullopt; }

 private:
  struct Attempt {
    std::vector<FoundPoint> found;
    PoseUpdate update;
  };

  void remember(const ImageFrame& frame);
  void chase();
  std::optional<Attempt> follow(const TrackAnchor& from, const MotionState& predicted, const FlowImage& flow) const;
  static void move_on(TrackAnchor& anchor, Timestamp time, const Attempt& attempt, const FlowImage& flow);
  FrameReport accept(FrameReport report, const MotionState& predicted, const Attempt& attempt, const FlowImage& flow);
  FrameReport pass(FrameReport report);

  Camera camera_;
  CameraTrackerOptions options_;
  std::optional<TrackAnchor> last_;    // the last frame, as the anchor of the next
  std::optional<TrackAnchor> newer_;   // one that has come since
  std::optional<TrackAnchor> chaser_;  // a late one on its way to the newest frame, while the camera is lost
  std::deque<ImageFrame> recent_;      // frames for it to be led through
  int missed_ = 0;                     // frames since the last measured one
};

}  // namespace alidade
