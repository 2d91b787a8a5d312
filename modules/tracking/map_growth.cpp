// SPDX-License-Identifier: Apache-2.0
#include "tracking/map_growth.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "reconstruction/epipolar_matching.h"

namespace alidade {
namespace {

struct FeatureView {
  int keyframe = -1;
  int feature = -1;
};

std::vector<int> free_features(const KeyframeFeatures& frame) {
  std::vector<int> free;
  for (std::size_t i = 0; i < frame.point_of_feature.size(); ++i) {
    if (frame.point_of_feature[i] < 0) free.push_back(static_cast<int>(i));
  }
  return free;
}

// Keyframes that share points with the last one and look from elsewhere: shared points, less where the baseline is
// under a twentieth of the depth.
std::vector<int> best_neighbours(const PointMap& map, int last, int count) {
  const std::vector<int> shared = shared_points(map, last);
  const double depth = std::max(1e-9, median_depth(map, last));
  const Eigen::Vector3d centre = map.keyframes[static_cast<std::size_t>(last)].T_world_camera.translation();
  std::vector<std::pair<double, int>> scored;
  for (int k = 0; k < last; ++k) {
    const double baseline = (map.keyframes[static_cast<std::size_t>(k)].T_world_camera.translation() - centre).norm();
    const double score = shared[static_cast<std::size_t>(k)] * std::min(1.0, baseline / depth / 0.05);
    if (score > 15.0) scored.emplace_back(-score, k);
  }
  std::sort(scored.begin(), scored.end());
  std::vector<int> chosen;
  for (std::size_t i = 0; i < scored.size() && static_cast<int>(i) < count; ++i) chosen.push_back(scored[i].second);
  return chosen;
}

void add_sighting(LiveMap& live, const FeatureView& view, int point, double sigma_px) {
  const auto k = static_cast<std::size_t>(view.keyframe);
  const auto f = static_cast<std::size_t>(view.feature);
  live.features[k].point_of_feature[f] = point;
  live.map.keyframes[k].sightings.push_back({point, live.features[k].features.pixels[f], sigma_px});
}

PosedSighting posed(const LiveMap& live, const FeatureView& view, double sigma_px) {
  const auto k = static_cast<std::size_t>(view.keyframe);
  const Keyframe& keyframe = live.map.keyframes[k];
  const auto& pixel = live.features[k].features.pixels[static_cast<std::size_t>(view.feature)];
  return {keyframe.T_world_camera, keyframe.covariance, pixel, sigma_px};
}

// A new point from one feature each of keyframes `last` and `other`; its index, or empty where the rays do not agree.
std::optional<int> add_point(const Camera& camera, LiveMap& live, const FeatureView& in_other,
                             const FeatureView& in_last, const cv::Mat& image, const GrowthOptions& options) {
  const PosedSighting pair[] = {posed(live, in_other, options.sigma_px), posed(live, in_last, options.sigma_px)};
  const auto meeting = triangulate(camera, pair, {options.least_angle_deg, 9.2});
  if (!meeting) return std::nullopt;
  const double range = (meeting->p_world - pair[1].T_world_camera.translation()).norm();
  if (std::sqrt(meeting->covariance_world.trace()) > options.most_depth_sigma * range) return std::nullopt;
  const Features& features = live.features[static_cast<std::size_t>(in_last.keyframe)].features;
  live.map.points.push_back({meeting->p_world, meeting->covariance_world, colour_at(image, pair[1].pixel),
                             descriptor_bytes(features, in_last.feature)});
  const int point = static_cast<int>(live.map.points.size()) - 1;
  add_sighting(live, in_other, point, options.sigma_px);
  add_sighting(live, in_last, point, options.sigma_px);
  return point;
}

// New points from the free features of keyframes `last` and `other`; returns the indices of the points.
std::vector<int> grow_between(const Camera& camera, LiveMap& live, int last, int other, const cv::Mat& image,
                              const GrowthOptions& options) {
  const KeyframeFeatures& a = live.features[static_cast<std::size_t>(last)];
  const KeyframeFeatures& b = live.features[static_cast<std::size_t>(other)];
  const std::vector<int> free_a = free_features(a);
  const std::vector<int> free_b = free_features(b);
  const auto pose = [&](int k) { return live.map.keyframes[static_cast<std::size_t>(k)].T_world_camera; };
  EpipolarOptions epipolar;
  epipolar.ratio = options.ratio;
  const auto matches =
      match_along_epipolar_lines(camera, {a.features, free_a, pose(last)}, {b.features, free_b, pose(other)}, epipolar);
  std::vector<int> grown;
  for (const Match& m : matches) {
    const auto point = add_point(camera, live, {other, m.b}, {last, m.a}, image, options);
    if (point) grown.push_back(*point);
  }
  return grown;
}

}  // namespace

std::array<std::uint8_t, 3> colour_at(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  if (image.empty()) return {128, 128, 128};
  const int x = std::clamp(static_cast<int>(std::lround(pixel.x())), 0, image.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(pixel.y())), 0, image.rows - 1);
  if (image.type() == CV_8UC1) {
    const auto v = image.at<std::uint8_t>(y, x);
    return {v, v, v};
  }
  const auto& bgr = image.at<cv::Vec3b>(y, x);
  return {bgr[2], bgr[1], bgr[0]};
}

LiveMap with_keyframe(LiveMap live, NewKeyframe added, double sigma_px) {
  KeyframeFeatures frame;
  frame.point_of_feature.assign(static_cast<std::size_t>(added.features.size()), -1);
  frame.features = std::move(added.features);
  frame.grey = added.grey;
  for (const FoundPoint& found : added.found) {
    added.keyframe.sightings.push_back({found.point, found.pixel, sigma_px});
    if (found.feature >= 0) frame.point_of_feature[static_cast<std::size_t>(found.feature)] = found.point;
  }
  live.map.keyframes.push_back(std::move(added.keyframe));
  live.features.push_back(std::move(frame));
  return live;
}

LiveMap with_points_of_pair(const Camera& camera, LiveMap live, const std::vector<Match>& matches, const cv::Mat& image,
                            const GrowthOptions& options) {
  for (const Match& m : matches) add_point(camera, live, {0, m.a}, {1, m.b}, image, options);
  return live;
}

LiveMap with_new_points(const Camera& camera, LiveMap live, const cv::Mat& image, const GrowthOptions& options) {
  const int last = static_cast<int>(live.map.keyframes.size()) - 1;
  std::vector<int> neighbours = best_neighbours(live.map, last, options.neighbours);
  std::erase_if(neighbours, [&](int k) { return live.features[static_cast<std::size_t>(k)].features.size() == 0; });
  std::vector<int> grown;
  for (int other : neighbours) {
    const auto points = grow_between(camera, live, last, other, image, options);
    grown.insert(grown.end(), points.begin(), points.end());
  }
  return complete_sightings(camera, std::move(live), grown, neighbours, 4.0).live;
}

Completion complete_sightings(const Camera& camera, LiveMap live, const std::vector<int>& points,
                              const std::vector<int>& keyframes, double radius_px) {
  Completion completion;
  SearchOptions search;
  search.most_radius_px = radius_px;
  for (int k : keyframes) {
    const auto i = static_cast<std::size_t>(k);
    const KeyframeFeatures& frame = live.features[i];
    std::vector<bool> seen(live.map.points.size(), false);
    for (const Sighting& s : live.map.keyframes[i].sightings) seen[static_cast<std::size_t>(s.point)] = true;
    std::vector<bool> taken(frame.point_of_feature.size());
    std::transform(frame.point_of_feature.begin(), frame.point_of_feature.end(), taken.begin(),
                   [](int point) { return point >= 0; });
    std::vector<int> unseen;
    std::copy_if(points.begin(), points.end(), std::back_inserter(unseen),
                 [&](int p) { return !seen[static_cast<std::size_t>(p)]; });
    const PoseBelief belief{live.map.keyframes[i].T_world_camera, live.map.keyframes[i].covariance};
    for (const FoundPoint& f : search_points(camera, live.map, unseen, belief, frame.features, taken, search)) {
      add_sighting(live, {k, f.feature}, f.point, search.sigma_px);
      ++completion.added;
    }
  }
  completion.live = std::move(live);
  return completion;
}

LiveMap with_retriangulated_points(const Camera& camera, LiveMap live) {
  const auto views = index_views(live.map);
  Keyframe& last = live.map.keyframes.back();
  std::vector<int> withdrawn;
  for (const Sighting& s : last.sightings) {
    const auto& point_views = views[static_cast<std::size_t>(s.point)];
    if (point_views.size() < 3) continue;  // a pair was triangulated when it was made
    MapPointOptions options;
    options.least_angle_deg = 0.2;
    const auto meeting = triangulate(camera, posed_sightings(live.map, point_views), options);
    if (!meeting) {
      withdrawn.push_back(s.point);
      continue;
    }
    live.map.points[static_cast<std::size_t>(s.point)].p_world = meeting->p_world;
    live.map.points[static_cast<std::size_t>(s.point)].covariance_world = meeting->covariance_world;
  }
  std::sort(withdrawn.begin(), withdrawn.end());
  std::erase_if(last.sightings,
                [&](const Sighting& s) { return std::binary_search(withdrawn.begin(), withdrawn.end(), s.point); });
  release_removed_sightings(live);
  return live;
}

}  // namespace alidade
