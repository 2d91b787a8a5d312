// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "features/sift.h"
#include "geometry/point_map.h"
#include "reconstruction/map_point.h"

namespace alidade {

/// The features of a keyframe and which map point each of them shows (-1: none yet).
struct KeyframeFeatures {
  Features features;
  std::vector<int> point_of_feature;
  cv::Mat grey;  ///< the image, for align_sightings
};

/// The map while it grows: what is published, and the features that it grows from (one entry per keyframe).
struct LiveMap {
  PointMap map;
  std::vector<KeyframeFeatures> features;
};

/// Where a point is seen: keyframe and the index of the sighting in it.
struct PointView {
  int keyframe = -1;
  int sighting = -1;
};

/// For every point, where it is seen.
std::vector<std::vector<PointView>> index_views(const PointMap& map);

/// The sightings of a point with the poses that they were made from.
std::vector<PosedSighting> posed_sightings(const PointMap& map, const std::vector<PointView>& views);

/// For every keyframe the number of points that it shares with keyframe `k` (itself: 0).
std::vector<int> shared_points(const PointMap& map, int k);

/// Points that have at least two sightings, or all where the map has no keyframes (a loaded map).
std::vector<int> living_points(const PointMap& map);

/// The map without the points that no keyframe sees any more, the others renumbered.
PointMap without_unseen_points(PointMap map);

/// Median depth of the points that a keyframe sees, m; 0 where it sees none.
double median_depth(const PointMap& map, int keyframe);

/// Takes the sightings that refinement has removed out of point_of_feature, so that those features can be matched anew.
void release_removed_sightings(LiveMap& live);

}  // namespace alidade
