// SPDX-License-Identifier: Apache-2.0
#include "tracking/live_map.h"

#include <algorithm>
#include <numeric>

namespace alidade {

std::vector<std::vector<PointView>> index_views(const PointMap& map) {
  std::vector<std::vector<PointView>> views(map.points.size());
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const auto& sightings = map.keyframes[k].sightings;
    for (std::size_t s = 0; s < sightings.size(); ++s) {
      views[static_cast<std::size_t>(sightings[s].point)].push_back({static_cast<int>(k), static_cast<int>(s)});
    }
  }
  return views;
}

std::vector<PosedSighting> posed_sightings(const PointMap& map, const std::vector<PointView>& views) {
  std::vector<PosedSighting> result;
  for (const PointView& view : views) {
    const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(view.keyframe)];
    const Sighting& s = keyframe.sightings[static_cast<std::size_t>(view.sighting)];
    result.push_back({keyframe.T_world_camera, keyframe.covariance, s.pixel, s.sigma_px});
  }
  return result;
}

std::vector<int> shared_points(const PointMap& map, int k) {
  std::vector<bool> seen(map.points.size(), false);
  for (const Sighting& s : map.keyframes[static_cast<std::size_t>(k)].sightings) {
    seen[static_cast<std::size_t>(s.point)] = true;
  }
  std::vector<int> shared(map.keyframes.size(), 0);
  for (std::size_t other = 0; other < map.keyframes.size(); ++other) {
    if (static_cast<int>(other) == k) continue;
    const auto& sightings = map.keyframes[other].sightings;
    shared[other] = static_cast<int>(std::count_if(sightings.begin(), sightings.end(), [&](const Sighting& s) {
      return seen[static_cast<std::size_t>(s.point)];
    }));
  }
  return shared;
}

std::vector<int> living_points(const PointMap& map) {
  std::vector<int> living;
  if (map.keyframes.empty()) {
    living.resize(map.points.size());
    std::iota(living.begin(), living.end(), 0);
    return living;
  }
  std::vector<int> count(map.points.size(), 0);
  for (const Keyframe& keyframe : map.keyframes) {
    for (const Sighting& s : keyframe.sightings) ++count[static_cast<std::size_t>(s.point)];
  }
  for (std::size_t i = 0; i < count.size(); ++i) {
    if (count[i] >= 2) living.push_back(static_cast<int>(i));
  }
  return living;
}

PointMap without_unseen_points(PointMap map) {
  if (map.keyframes.empty()) return map;
  const auto views = index_views(map);
  std::vector<int> new_index(map.points.size(), -1);
  std::vector<MapPoint> seen;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].empty()) continue;
    new_index[i] = static_cast<int>(seen.size());
    seen.push_back(map.points[i]);
  }
  map.points = std::move(seen);
  for (Keyframe& keyframe : map.keyframes) {
    for (Sighting& s : keyframe.sightings) s.point = new_index[static_cast<std::size_t>(s.point)];
  }
  return map;
}

double median_depth(const PointMap& map, int k) {
  const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(k)];
  if (keyframe.sightings.empty()) return 0.0;
  const Eigen::Isometry3d T_camera_world = keyframe.T_world_camera.inverse();
  std::vector<double> depths;
  for (const Sighting& s : keyframe.sightings) {
    depths.push_back((T_camera_world * map.points[static_cast<std::size_t>(s.point)].p_world).z());
  }
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

void release_removed_sightings(LiveMap& live) {
  std::vector<bool> seen(live.map.points.size());
  for (std::size_t k = 0; k < live.features.size(); ++k) {
    std::fill(seen.begin(), seen.end(), false);
    for (const Sighting& s : live.map.keyframes[k].sightings) seen[static_cast<std::size_t>(s.point)] = true;
    for (int& point : live.features[k].point_of_feature) {
      if (point >= 0 && !seen[static_cast<std::size_t>(point)]) point = -1;
    }
  }
}

}  // namespace alidade
