// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tracking/anchor_follower.h"
#include "tracking/camera_tracker_options.h"
#include "tracking/frame.h"
#include "tracking/live_map.h"
#include "tracking/live_motion.h"
#include "tracking/localiser.h"
#include "tracking/slam_track.h"
#include "tracking/starter.h"

namespace alidade {

/// Follows one camera through images taken in order: waits until two of them make a map, then for each predicts, finds
/// map points near where they are expected, updates the state, and at keyframes lets the map grow.
/// Source: camera-tracker paper, "Steps"; what is ours is listed there under "Where we go past it".
class CameraTracker {
 public:
  /// With `known_map` the camera is localised in it and the map does not change. `given_poses`: see MapStarter.
  CameraTracker(Camera camera, CameraTrackerOptions options, std::optional<PointMap> known_map = std::nullopt,
                Trajectory given_poses = {});

  /// Takes the next image. The report is also kept in reports(), without its outliers and expectations; there a later
  /// start may give poses to frames that waited.
  FrameReport step(const ImageFrame& frame);

  const std::vector<FrameReport>& reports() const { return reports_; }
  /// What is known of the last image, for one that follows the camera from it while this tracker takes its time over
  /// the next; empty while the camera is not measured.
  std::optional<TrackAnchor> anchor() const;

  /// Goes on from a frame in which somebody else has followed the points of this map, as if it had taken that frame
  /// itself.
  void resume_from(TrackAnchor last);

  const LiveMap& live_map() const { return live_; }
  const Camera& camera() const { return camera_; }
  const CameraTrackerOptions& options() const { return options_; }
  bool localises_only() const { return localises_only_; }
  /// How many of the first keyframes stand where the user said (2) or merely hold the gauge (1).
  int anchored_keyframes() const { return anchored_keyframes_; }

 private:
  FrameReport wait(const ImageFrame& frame, const FlowImage& flow);
  FrameReport track(const ImageFrame& frame, const FlowImage& flow);
  void adopt(StartedMap started, const ImageFrame& frame);

  Localiser localiser() const;
  double median_range(const Eigen::Isometry3d& T_world_camera, const std::vector<FoundPoint>& found) const;

  FrameReport accept(const ImageFrame& frame, const MotionState& predicted, Localisation attempt);
  void move_on(const ImageFrame& frame, const Localisation& attempt);
  std::vector<FrameExpectation> expectations(const MotionState& predicted, const std::vector<FoundPoint>& found) const;
  FrameReport lose(const ImageFrame& frame, const MotionState& predicted);
  bool keyframe_is_due(const Localisation& attempt) const;
  void add_keyframe(const ImageFrame& frame, Localisation& attempt);
  void retrack_from_last_keyframe();
  void learn_sighting_noise(const PoseUpdate& update);
  PoseUpdate estimate_with_map(Timestamp time, const MotionState& predicted, const Localisation& attempt);

  Camera camera_;
  CameraTrackerOptions options_;
  bool localises_only_ = false;
  int anchored_keyframes_ = 1;
  LiveMotion motion_;
  MapStarter starter_;
  LiveMap live_;
  std::vector<int> living_;        // indices of the points worth looking for
  std::optional<SlamTrack> slam_;  // PoseMethod::EkfSlam's own state
  double sigma_px_ = 1.0;
  std::vector<FoundPoint> tracks_;   // points in the previous frame, to be followed
  std::size_t keyframe_tracks_ = 0;  // how many there were at the last keyframe
  Eigen::Isometry3d T_world_keyframe_ = Eigen::Isometry3d::Identity();
  FlowImage previous_;
  Timestamp previous_time_{};
  double frame_s_ = 1.0 / 30.0;  // from the last image to this one
  int frames_since_anchor_ = 0;  // since flow was last corrected by features
  int missed_ = 0;               // frames since the last measured one
  bool has_pose_ = false;        // false: lost, or not yet located in a known map
  std::vector<FrameReport> reports_;
};

}  // namespace alidade
