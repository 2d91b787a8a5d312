// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "camera/camera.h"
#include "geometry/pose.h"

namespace alidade {

/// The same scene point in two images of one camera, px.
struct PixelPair {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

struct TwoViewOptions {
  double threshold_px = 1.5;        ///< of the distance from the epipolar line; three sigmas of a SIFT feature
  int least_inliers = 60;           ///< fewer do not carry a map
  double least_share = 0.4;         ///< of the pairs that must agree with one motion
  double least_parallax_deg = 1.5;  ///< median angle between the two rays of a point: below it, depth is guesswork
  double planar_share = 0.9;  ///< homography inliers over essential inliers from which the scene counts as a plane
};

/// Whether two views fix a relative pose, or why they do not yet.
enum class TwoViewOutcome { Solved, TooFewMatches, NoCommonMotion, TooLittleParallax, PlanarAmbiguity };

/// The relative pose of two views, the baseline as unit of length.
struct TwoViewGeometry {
  TwoViewOutcome outcome = TwoViewOutcome::TooFewMatches;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  std::vector<int> inliers;        ///< indices of the pairs that agree and lie in front of both cameras
  double median_parallax_deg = 0;  ///< of the agreeing pairs; 0 where none do
  double homography_share = 0;     ///< homography inliers over essential inliers
};

/// Relative pose by the five-point algorithm in RANSAC, or from a homography where the scene is a plane; outcome tells
/// whether it is fit to start a map from. Deterministic. Sources: Nistér 2004; Malis and Vargas 2007 (planes).
TwoViewGeometry solve_two_views(const Camera& camera, const std::vector<PixelPair>& pairs,
                                const TwoViewOptions& options = {});

/// One line for the user: why these two views do not start a map ("parallax 0.4° of the 1.5° needed: ...").
std::string explain(const TwoViewGeometry& geometry, const TwoViewOptions& options);

}  // namespace alidade
