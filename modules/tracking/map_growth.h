// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "camera/camera.h"
#include "tracking/live_map.h"
#include "tracking/map_search.h"

namespace alidade {

struct GrowthOptions {
  int neighbours = 5;             ///< keyframes that a new one is matched with
  double ratio = 0.8;             ///< of the descriptor distances, nearest to second nearest
  double least_angle_deg = 1.0;   ///< between the two rays of a new point
  double most_depth_sigma = 0.2;  ///< of a new point, as a share of its distance
  double sigma_px = 1.0;          ///< of a SIFT feature
};

/// The colour (RGB) of an 8-bit image, grey or BGR, at the pixel nearest to `pixel`; grey for an empty image.
std::array<std::uint8_t, 3> colour_at(const cv::Mat& image, const Eigen::Vector2d& pixel);

/// Appends a keyframe: its pose, its features, and the map points found in it.
struct NewKeyframe {
  Keyframe keyframe;
  Features features;
  std::vector<FoundPoint> found;
  cv::Mat grey;
};
LiveMap with_keyframe(LiveMap live, NewKeyframe added, double sigma_px);

/// Adds the points that a first pair of keyframes agrees on: `matches` between the features of keyframe 0 (a) and 1
/// (b).
LiveMap with_points_of_pair(const Camera& camera, LiveMap live, const std::vector<Match>& matches, const cv::Mat& image,
                            const GrowthOptions& options);

/// Matches the last keyframe's free features with those of its best neighbours and adds the points that they agree on,
/// each with its covariance, coloured from `image` (of the last keyframe); looks for the new points in the other
/// neighbours as well. Returns the grown map.
LiveMap with_new_points(const Camera& camera, LiveMap live, const cv::Mat& image, const GrowthOptions& options);

/// Looks for points in keyframes that show them without having been matched yet (radius `radius_px` about their
/// projection) and adds the sightings. Returns the map and how many were added.
struct Completion {
  LiveMap live;
  int added = 0;
};
Completion complete_sightings(const Camera& camera, LiveMap live, const std::vector<int>& points,
                              const std::vector<int>& keyframes, double radius_px);

/// Triangulates every point of the last keyframe anew from all its sightings, poses with their covariances; where they
/// disagree, the last sighting is withdrawn.
LiveMap with_retriangulated_points(const Camera& camera, LiveMap live);

}  // namespace alidade
