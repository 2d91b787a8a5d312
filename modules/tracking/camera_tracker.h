// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "features/flow.h"
#include "tracking/camera_state.h"
#include "tracking/frame.h"
#include "tracking/live_map.h"
#include "tracking/map_growth.h"
#include "tracking/map_search.h"
#include "tracking/pose_method.h"
#include "tracking/starter.h"

namespace alidade {

/// How a frame's map points are found again.
enum class FeatureMode {
  Auto,  ///< optical flow between keyframes; SIFT where flow loses its hold (stills, jumps) and on keyframes
  Sift,  ///< SIFT in every frame, matched with the map by descriptor alone: slow, to compare with
};

struct CameraTrackerOptions {
  PoseMethod pose = PoseMethod::Ekf;
  FeatureMode features = FeatureMode::Auto;
  bool local_refinement = true;  ///< bundle adjustment of the last keyframes at every new one
  SiftOptions sift;
  FlowOptions flow;
  StarterOptions start;
  PoseUpdateOptions update;
  GrowthOptions growth;
  double sigma_px = 1.0;  ///< of a feature, until the residuals have told better
  int most_tracks = 600;  ///< points followed by flow; more add time, hardly accuracy
  double weak_share =
      0.3;  ///< of the last keyframe's points; a search with fewer inliers is compared with a match anywhere
  double least_flow_share = 0.3;       ///< of the points followed; below it flow has lost its hold and SIFT is asked
  int least_inliers = 20;              ///< a pose from fewer points is not believed
  double least_inlier_share = 0.35;    ///< of the points found; a pose that most of them contradict is not believed
  double keyframe_share = 0.6;         ///< a keyframe is due when fewer of the last one's points are still followed
  double keyframe_parallax_deg = 3.0;  ///< or when the median ray to them has turned by more
  int anchor_every = 1;                ///< in a known map: frames after which flow is corrected by features
  int most_predicted = 5;              ///< frames without measurement after which the camera counts as lost
  int window = 8;                      ///< keyframes that local refinement moves
  int most_fixed = 12;                 ///< and those that hold them
  double relocalisation_ratio = 0.8;   ///< of descriptor distances
};

/// Features per keyframe for images of this size: one per 100 px², 1000 to 6000.
int suggested_feature_count(const Camera& camera);

/// Throws std::invalid_argument naming the field, its value and the bound.
void validate(const CameraTrackerOptions& options);

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
  const LiveMap& live_map() const { return live_; }
  const Camera& camera() const { return camera_; }
  const CameraTrackerOptions& options() const { return options_; }
  bool localises_only() const { return localises_only_; }
  /// How many of the first keyframes stand where the user said (2) or merely hold the gauge (1).
  int anchored_keyframes() const { return anchored_keyframes_; }
  const MotionNoise& motion_noise() const { return noise_; }

 private:
  // What one way of looking has brought.
  struct Attempt {
    std::vector<FoundPoint> found;
    std::optional<PoseUpdate> update;
    std::optional<Features> features;  // where SIFT was run
    bool used_prior = true;
  };

  FrameReport wait(const ImageFrame& frame, const FlowImage& flow);
  FrameReport track(const ImageFrame& frame, const FlowImage& flow);
  void adopt(StartedMap started, const ImageFrame& frame);

  Attempt follow(const CameraState& predicted, const FlowImage& flow) const;
  Attempt search(const CameraState& predicted, const ImageFrame& frame) const;
  Attempt relocalise(const CameraState& predicted, const ImageFrame& frame, std::optional<Features> features) const;
  std::vector<int> recent_points() const;
  Attempt widen(const CameraState& predicted, Attempt first) const;
  Attempt match_every_descriptor(const CameraState& predicted, const ImageFrame& frame) const;
  std::optional<PoseUpdate> estimate(const CameraState& predicted, const std::vector<FoundPoint>& found,
                                     bool use_prior) const;
  double median_range(const Eigen::Isometry3d& T_world_camera, const std::vector<FoundPoint>& found) const;
  bool is_believable(const Attempt& attempt) const;
  bool is_weak(const Attempt& attempt) const;

  FrameReport accept(const ImageFrame& frame, const CameraState& predicted, Attempt attempt);
  std::vector<FrameExpectation> expectations(const CameraState& predicted, const std::vector<FoundPoint>& found) const;
  FrameReport lose(const ImageFrame& frame, const CameraState& predicted);
  bool keyframe_is_due(const Attempt& attempt) const;
  void anchor_in_features(const ImageFrame& frame, const CameraState& predicted, Attempt& attempt) const;
  void add_keyframe(const ImageFrame& frame, Attempt& attempt);
  std::vector<FoundPoint> snapped_to_features(const std::vector<FoundPoint>& found, const Features& features,
                                              bool drop_others) const;
  void refine_locally();
  void retrack_from_last_keyframe();
  void learn_noise(const PoseUpdate& update);

  Camera camera_;
  CameraTrackerOptions options_;
  bool localises_only_ = false;
  int anchored_keyframes_ = 1;
  MapStarter starter_;
  LiveMap live_;
  std::vector<int> living_;  // indices of the points worth looking for
  CameraState state_;
  MotionNoise noise_;
  double sigma_px_ = 1.0;
  std::vector<FoundPoint> tracks_;   // points in the previous frame, to be followed
  std::size_t keyframe_tracks_ = 0;  // how many there were at the last keyframe
  Eigen::Isometry3d T_world_keyframe_ = Eigen::Isometry3d::Identity();
  FlowImage previous_;
  int frames_since_anchor_ = 0;  // since flow was last corrected by features
  int missed_ = 0;               // frames since the last measured one
  bool has_pose_ = false;        // false: lost, or not yet located in a known map
  std::vector<FrameReport> reports_;
};

}  // namespace alidade
