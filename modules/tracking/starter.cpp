// SPDX-License-Identifier: Apache-2.0
#include "tracking/starter.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "estimation/pose_update.h"
#include "features/matching.h"
#include "reconstruction/bundle_covariance.h"
#include "tracking/map_growth.h"
#include "tracking/map_search.h"

namespace alidade {

MapStarter::MapStarter(Camera camera, StarterOptions options, Trajectory given_poses)
    : camera_(camera), options_(options), given_poses_(std::move(given_poses)) {}

std::optional<StartedMap> MapStarter::add(const ImageFrame& frame, const FlowImage& flow) {
  if (!reference_) {
    begin(frame, flow);
    reason_ = "the first image: a second one is needed";
    return std::nullopt;
  }
  follow(flow);
  const auto alive = std::count_if(tracks_.begin(), tracks_.end(), [](const auto& t) { return t.has_value(); });
  const bool followed = static_cast<double>(alive) >= options_.least_survivors * static_cast<double>(tracks_.size()) &&
                        alive >= options_.two_view.least_inliers;
  auto started = followed ? try_flow(frame) : try_descriptors(frame);
  if (started) return started;
  Waiting waiting;
  waiting.report.index = frame.index;
  waiting.report.time = frame.time;
  waiting.report.name = frame.name;
  waiting.pixels = tracks_;
  waiting_.push_back(std::move(waiting));
  if (!followed) begin(frame, flow);  // out of sight of the reference: start over from here
  return std::nullopt;
}

void MapStarter::begin(const ImageFrame& frame, const FlowImage& flow) {
  reference_ = frame;
  reference_features_ = detect_sift(frame.grey, options_.sift);
  previous_ = flow;
  tracks_.assign(reference_features_.pixels.begin(), reference_features_.pixels.end());
  waiting_.clear();
}

void MapStarter::follow(const FlowImage& flow) {
  std::vector<Eigen::Vector2d> pixels;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!tracks_[i]) continue;
    pixels.push_back(*tracks_[i]);
    index.push_back(i);
  }
  const auto next = follow_points(previous_, flow, pixels, pixels, options_.flow);
  for (std::size_t k = 0; k < index.size(); ++k) tracks_[index[k]] = next[k];
  previous_ = flow;
}

std::vector<PixelPair> MapStarter::followed_pairs(std::vector<int>& features) const {
  std::vector<PixelPair> pairs;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!tracks_[i]) continue;
    pairs.push_back({reference_features_.pixels[i], *tracks_[i]});
    features.push_back(static_cast<int>(i));
  }
  return pairs;
}

double MapStarter::median_motion(const std::vector<PixelPair>& pairs) const {
  if (pairs.empty()) return 0.0;
  std::vector<double> motion;
  for (const PixelPair& pair : pairs) motion.push_back((pair.a - pair.b).norm());
  const auto middle = motion.begin() + static_cast<std::ptrdiff_t>(motion.size() / 2);
  std::nth_element(motion.begin(), middle, motion.end());
  return *middle;
}

std::optional<StartedMap> MapStarter::try_flow(const ImageFrame& frame) {
  std::vector<int> features;
  const auto pairs = followed_pairs(features);
  if (median_motion(pairs) < options_.least_motion_share * camera_.width) {
    reason_ = "the camera has hardly moved: move it sideways";
    return std::nullopt;
  }
  const TwoViewGeometry geometry = solve_two_views(camera_, pairs, options_.two_view);
  reason_ = explain(geometry, options_.two_view);
  if (geometry.outcome != TwoViewOutcome::Solved) return std::nullopt;
  return try_descriptors(frame);  // flow has drifted a little since the reference; descriptors have not
}

std::optional<StartedMap> MapStarter::try_descriptors(const ImageFrame& frame) {
  Features features = detect_sift(frame.grey, options_.sift);
  const auto matches = match_descriptors(reference_features_.descriptors, features.descriptors, options_.ratio);
  std::vector<PixelPair> pairs;
  for (const Match& m : matches) {
    pairs.push_back(
        {reference_features_.pixels[static_cast<std::size_t>(m.a)], features.pixels[static_cast<std::size_t>(m.b)]});
  }
  const TwoViewGeometry geometry = solve_two_views(camera_, pairs, options_.two_view);
  reason_ = explain(geometry, options_.two_view);
  if (geometry.outcome != TwoViewOutcome::Solved) return std::nullopt;
  return build(frame, std::move(features), matches, geometry);
}

StartedMap MapStarter::build(const ImageFrame& frame, Features features, const std::vector<Match>& matches,
                             const TwoViewGeometry& geometry) const {
  StartedMap started;
  const auto given_a = given_pose(reference_->time);
  const auto given_b = given_pose(frame.time);
  started.poses_were_given = given_a && given_b;
  const Eigen::Isometry3d T_world_a = given_a.value_or(Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d T_world_b = started.poses_were_given ? *given_b : T_world_a * geometry.T_a_b;

  LiveMap& live = started.live;
  NewKeyframe a{{reference_->index, reference_->time, reference_->name, T_world_a, Matrix6d::Zero(), {}},
                reference_features_,
                {},
                reference_->grey};
  NewKeyframe b{
      {frame.index, frame.time, frame.name, T_world_b, Matrix6d::Zero(), {}}, std::move(features), {}, frame.grey};
  live = with_keyframe(with_keyframe({}, std::move(a), options_.sigma_px), std::move(b), options_.sigma_px);
  std::vector<Match> agreed;
  for (int i : geometry.inliers) agreed.push_back(matches[static_cast<std::size_t>(i)]);
  GrowthOptions growth;
  growth.sigma_px = options_.sigma_px;
  growth.least_angle_deg = 0.3 * options_.two_view.least_parallax_deg;
  growth.most_depth_sigma = 0.5;
  live = with_points_of_pair(camera_, std::move(live), agreed, frame.colour, growth);

  const BundleOptions bundle = global_bundle_options(live.map, started.poses_were_given ? 2 : 1);
  if (!started.poses_were_given) {
    live.map = adjust_bundle(camera_, std::move(live.map), bundle).map;
    live.map = remove_outlying_sightings(camera_, std::move(live.map), 4.0).map;
    release_removed_sightings(live);
    live.map = with_covariances(camera_, std::move(live.map), bundle);
  }
  started.in_between = locate_waiting(live);
  return started;
}

std::vector<FrameReport> MapStarter::locate_waiting(const LiveMap& live) const {
  const Keyframe& a = live.map.keyframes[0];
  const Keyframe& b = live.map.keyframes[1];
  std::vector<FrameReport> located;
  for (const Waiting& waiting : waiting_) {
    std::vector<PointObservation> observations;
    FrameReport report = waiting.report;
    for (std::size_t f = 0; f < waiting.pixels.size(); ++f) {
      const int point = live.features[0].point_of_feature[f];
      if (point < 0 || !waiting.pixels[f]) continue;
      const MapPoint& p = live.map.points[static_cast<std::size_t>(point)];
      observations.push_back(as_observation(p, *waiting.pixels[f], options_.sigma_px));
      report.sightings.push_back({point, *waiting.pixels[f], false});
    }
    PosePrior prior;
    const double fraction = to_seconds(report.time - a.time) / to_seconds(b.time - a.time);
    prior.T_world_camera = interpolate(a.T_world_camera, b.T_world_camera, fraction);
    const auto update = update_pose(camera_, prior, observations, {.map_uncertainty = MapUncertainty::Inflated});
    if (!update) continue;
    report.state = FrameState::Tracked;
    report.T_world_camera = update->T_world_camera;
    report.covariance = update->covariance;
    report.chi2_per_dof = update->chi2_per_dof;
    for (std::size_t i = 0; i < observations.size(); ++i) report.sightings[i].is_inlier = update->is_inlier[i];
    located.push_back(std::move(report));
  }
  return located;
}

std::optional<Eigen::Isometry3d> MapStarter::given_pose(Timestamp time) const {
  const auto found = std::find_if(given_poses_.begin(), given_poses_.end(), [&](const StampedPose& pose) {
    return std::abs(to_seconds(pose.time - time)) < 1e-3;
  });
  if (found == given_poses_.end()) return std::nullopt;
  return found->T_world_camera;
}

}  // namespace alidade
