// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "camera/camera.h"
#include "features/marker.h"
#include "geometry/alignment.h"
#include "geometry/point_map.h"
#include "tracking/frame.h"

namespace alidade {

/// A map and reports moved into another frame and scale, with their covariances.
PointMap transform(const Similarity& similarity, PointMap map);
std::vector<FrameReport> transform(const Similarity& similarity, std::vector<FrameReport> reports);

/// One camera alone does not know the unit of length, nor where the world's origin is. Each of these finds the
/// similarity T_metric_map that something known tells; empty where it does not (see each).

/// From the poses that the user knows: the scale from the distances between their centres, the frame from the first of
/// them. Empty where fewer than two of them belong to posed frames or their centres coincide.
std::optional<Similarity> similarity_to_given_poses(const std::vector<FrameReport>& reports, const Trajectory& given);

/// From the distance, in m, between the camera's centres at two frames. Empty where one has no pose or they coincide.
struct KnownDistance {
  int frame_a = 0;
  int frame_b = 0;
  double distance_m = 0.0;
};
std::optional<Similarity> similarity_from_distance(const std::vector<FrameReport>& reports, const KnownDistance& known);

/// The markers seen in one frame.
struct FrameMarkers {
  int frame = 0;
  std::vector<MarkerSighting> markers;
};

/// From a square marker of side `side_m` that at least two posed frames show: the scale, and the frame of the marker
/// (origin in its centre, x to its right, y up along it, z out of it). Of several markers the one seen in most of these
/// frames is taken; `id` picks one. Empty where none is seen twice or its corners form no square (sides within 5 %).
std::optional<Similarity> similarity_from_marker(const Camera& camera, const std::vector<FrameReport>& reports,
                                                 const std::vector<FrameMarkers>& seen, double side_m,
                                                 std::optional<int> id = std::nullopt);

}  // namespace alidade
