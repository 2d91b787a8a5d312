// SPDX-License-Identifier: Apache-2.0
#include "tracking/slam_track.h"

#include <algorithm>
#include <map>

namespace alidade {
namespace {

using Sightings = std::map<int, Eigen::Vector2d>;  // pixel of a map point

// Those of the state's points that stay.
std::vector<int> kept_points(const SlamTrack& track, std::span<const int> living, const Sightings& seen,
                             std::size_t most_points) {
  std::vector<int> alive, seen_again;
  for (int j = 0; j < static_cast<int>(track.map_points.size()); ++j) {
    const int point = track.map_points[static_cast<std::size_t>(j)];
    if (!std::binary_search(living.begin(), living.end(), point)) continue;
    alive.push_back(j);
    if (seen.contains(point)) seen_again.push_back(j);
  }
  const std::size_t wanted = alive.size() + seen.size() - seen_again.size();
  return wanted <= most_points ? alive : seen_again;
}

SlamTrack with_only(const SlamTrack& track, const std::vector<int>& kept) {
  SlamTrack smaller{with_only_points(track.state, kept), {}};
  for (int j : kept) smaller.map_points.push_back(track.map_points[static_cast<std::size_t>(j)]);
  return smaller;
}

SlamTrack with_new_points(SlamTrack track, const PointMap& map, const Sightings& seen, std::size_t most_points) {
  std::vector<int> candidates;
  for (const auto& [point, pixel] : seen) {
    const auto& known = track.map_points;
    if (std::find(known.begin(), known.end(), point) == known.end()) candidates.push_back(point);
  }
  const std::size_t room = most_points - std::min(most_points, track.map_points.size());
  const std::size_t count = std::min(room, candidates.size());
  std::vector<SlamPoint> entering;
  for (std::size_t i = 0; i < count; ++i) {  // every n-th: spread as the candidates are
    const int point = candidates[i * candidates.size() / count];
    const MapPoint& p = map.points[static_cast<std::size_t>(point)];
    entering.push_back({p.p_world, p.covariance_world, {}});
    track.map_points.push_back(point);
  }
  track.state = with_points(std::move(track.state), entering);
  return track;
}

}  // namespace

SlamTrack follow(const Camera& camera, const SlamTrack& track, const PointMap& map, std::span<const int> living,
                 const SlamFrame& frame, int most_points) {
  Sightings seen;
  for (const FoundPoint& f : frame.inliers) seen[f.point] = f.pixel;
  const auto most = static_cast<std::size_t>(most_points);
  SlamTrack next = with_new_points(with_only(track, kept_points(track, living, seen, most)), map, seen, most);
  std::vector<SlamSighting> sightings;
  for (int j = 0; j < static_cast<int>(next.map_points.size()); ++j) {
    const auto sighting = seen.find(next.map_points[static_cast<std::size_t>(j)]);
    if (sighting != seen.end()) sightings.push_back({j, sighting->second, frame.sigma_px});
  }
  next.state = update_slam_filter(camera, predict(next.state, frame.time, frame.noise), sightings);
  return next;
}

}  // namespace alidade
