// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"
#include "estimation/pose_update.h"
#include "features/flow.h"
#include "features/sift.h"
#include "tracking/map_growth.h"
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
  int slam_points = 100;  ///< PoseMethod::EkfSlam: most points in its state, MonoSLAM's number at 30 Hz
  FeatureMode features = FeatureMode::Auto;
  /// Global refinement will follow: sightings of frames and images of keyframes are kept for it. Without, an hour of
  /// frames takes a hundredth of the memory, and old keyframes are no longer matched with new ones.
  bool will_be_refined = true;
  bool local_refinement = true;  ///< bundle adjustment of the last keyframes at every new one
  SiftOptions sift;
  FlowOptions flow;
  StarterOptions start;
  /// A map's points have errors in common, which refitting each by itself makes worse: they are left where they are.
  PoseUpdateOptions update{.map_uncertainty = MapUncertainty::Inflated};
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

}  // namespace alidade
