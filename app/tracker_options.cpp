// SPDX-License-Identifier: Apache-2.0
#include "app/tracker_options.h"

namespace alidade {

void bind(OptionFields& fields, CameraTrackerOptions& o) {
  fields.add_choice("pose", o.pose,
                    {{"ekf", PoseMethod::Ekf},
                     {"ekf-paper", PoseMethod::EkfPaper},
                     {"ukf", PoseMethod::Ukf},
                     {"ekf-slam", PoseMethod::EkfSlam},
                     {"epnp", PoseMethod::Epnp},
                     {"epnp-lm", PoseMethod::EpnpLm},
                     {"sqpnp", PoseMethod::Sqpnp}},
                    "what turns a frame's points into a pose");
  fields.add("slam_points", o.slam_points, "", "pose ekf-slam: most points in its state");
  fields.add_choice("features", o.features, {{"auto", FeatureMode::Auto}, {"sift", FeatureMode::Sift}},
                    "auto: optical flow between keyframes; sift: in every frame, matched by brute force");
  fields.add("sigma_px", o.sigma_px, "px", "measurement noise to begin with; the residuals correct it");
  fields.add("sift.most", o.sift.most, "", "features per keyframe; 0: by the size of the images");
  fields.add("sift.fewest", o.sift.fewest, "", "below it the contrast threshold is lowered");
  fields.add("sift.contrast", o.sift.contrast, "", "contrast threshold, grey levels of 0-1");
  fields.add("start.least_parallax_deg", o.start.two_view.least_parallax_deg, "deg",
             "median angle between the rays of the first two keyframes");
  fields.add("start.least_inliers", o.start.two_view.least_inliers, "", "matches that the first two keyframes need");
  fields.add("update.gate_chi2", o.update.gate_chi2, "",
             "squared whitened residual beyond which a match is an outlier");
  fields.add_choice("update.map_uncertainty", o.update.map_uncertainty,
                    {{"ignored", MapUncertainty::Ignored},
                     {"inflated", MapUncertainty::Inflated},
                     {"refitted", MapUncertainty::Refitted}},
                    "the map's covariance: left out; added to the measurement noise; and its points fitted along");
  fields.add("growth.neighbours", o.growth.neighbours, "", "keyframes that a new one is matched with");
  fields.add("growth.ratio", o.growth.ratio, "", "descriptor distance, nearest to second nearest");
  fields.add("growth.least_angle_deg", o.growth.least_angle_deg, "deg", "between the rays of a new point");
  fields.add("most_tracks", o.most_tracks, "", "points followed by optical flow; of a live camera at most 300");
  fields.add("least_inliers", o.least_inliers, "", "points without which no pose is believed");
  fields.add("keyframe_share", o.keyframe_share, "",
             "of the last keyframe's points still followed: below it a new one");
  fields.add("keyframe_parallax_deg", o.keyframe_parallax_deg, "deg", "turn of the median ray: beyond it a new one");
  fields.add("anchor_every", o.anchor_every, "", "in a known map: frames after which flow is corrected by features");
  fields.add("most_predicted", o.most_predicted, "", "frames without measurement before the camera counts as lost");
  fields.add("window", o.window, "", "keyframes that local refinement moves");
}

}  // namespace alidade
