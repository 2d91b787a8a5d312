// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "estimation/motion_state.h"
#include "tracking/camera_tracker_options.h"
#include "tracking/map_search.h"

namespace alidade {

/// What one way of looking for the map in an image has brought.
struct Localisation {
  std::vector<FoundPoint> found;
  std::optional<PoseUpdate> update;  ///< from the points found; empty where they gave no pose
  std::optional<Features> features;  ///< where SIFT was run
  bool used_prior = true;
};

/// The points found that an update went by.
std::vector<FoundPoint> inliers_of(const std::vector<FoundPoint>& found, const PoseUpdate& update);

/// The points of the previous image, to be followed into the next.
struct FollowedPoints {
  const FlowImage& image;
  const Eigen::Isometry3d& T_world_camera;
  const std::vector<FoundPoint>& points;
};

/// The ways to find the points of a map, as it stands, in one more image (8-bit grey), and the camera's pose by them.
/// Made anew for every image: it refers to what it is given.
class Localiser {
 public:
  /// `points`: indices of those worth looking for. A map that is known does not grow: what is found in it is a feature.
  Localiser(const Camera& camera, const PointMap& map, const std::vector<int>& points,
            const CameraTrackerOptions& options, double sigma_px, bool map_is_known);

  /// By optical flow from the image before. Without an update where flow has lost its hold.
  Localisation follow(const FollowedPoints& last, const MotionState& predicted, const FlowImage& flow) const;

  /// By SIFT, each point inside its innovation ellipse about where it is expected.
  Localisation search(const MotionState& predicted, const cv::Mat& grey) const;

  /// By descriptors alone and PnP in RANSAC: no prediction is needed. `features`: the image's, where they are known.
  Localisation relocalise(const MotionState& predicted, const cv::Mat& grey, std::optional<Features> features) const;

  /// By descriptors in all of the map, the prediction deciding what fits (where there is one): slow, to compare with.
  Localisation match_every_descriptor(const MotionState& predicted, const cv::Mat& grey, bool use_prior) const;

  /// Followed points take the place of the feature near by, and the rest of the map is looked for close to where it
  /// must be: what flow has drifted is taken back, what it has lost returns. `attempt` itself where that brings no
  /// pose.
  Localisation anchor_in_features(const MotionState& predicted, const cv::Mat& grey, Localisation attempt) const;

  /// Whether there is a pose, by enough points and by most of those found.
  bool is_believable(const Localisation& attempt) const;

  /// Whether it is by few of the points that the last keyframe has.
  bool is_weak(const Localisation& attempt) const;

 private:
  std::optional<PoseUpdate> estimate(const MotionState& predicted, const std::vector<FoundPoint>& found,
                                     bool use_prior) const;
  Localisation widen(const MotionState& predicted, Localisation first) const;
  std::vector<FoundPoint> snapped_to_features(const std::vector<FoundPoint>& found, const Features& features,
                                              bool drop_others) const;
  std::vector<int> recent_points() const;

  const Camera& camera_;
  const PointMap& map_;
  const std::vector<int>& points_;
  const CameraTrackerOptions& options_;
  double sigma_px_;
  bool map_is_known_;
};

}  // namespace alidade
